#include "core/segment_voronoi/build/brio.hpp"

#include <bit>
#include <cstddef>
#include <numeric>

namespace vorotool::core::segment_voronoi::build {
namespace {

constexpr int rounds = 16;  // 4^16 = 2^32 items leave one to the first round

// The finalizer of splitmix64 (Steele, Lea and Flood 2014): every bit of the result depends on all of x.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

// Two bits decide a quarter: round r before the last with a chance of 3/4 * 4^-r.
std::size_t round_of(std::size_t item) {
  const int earlier = std::countr_zero(mixed(item) | std::uint64_t{1} << (2 * rounds - 1)) / 2;
  return static_cast<std::size_t>(rounds - 1 - earlier);
}

}  // namespace

Brio make_brio(std::size_t count) {
  Brio order{std::vector<std::int32_t>(count), std::vector<std::size_t>(rounds + 1)};
  for (std::size_t item = 0; item < count; ++item) ++order.begin[round_of(item) + 1];
  std::partial_sum(order.begin.begin(), order.begin.end(), order.begin.begin());
  std::vector<std::size_t> next = order.begin;
  for (std::size_t item = 0; item < count; ++item) {
    order.items[next[round_of(item)]++] = static_cast<std::int32_t>(item);
  }
  return order;
}

}  // namespace vorotool::core::segment_voronoi::build
