#include "core/base/radix_sort.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

namespace vorotool::core::base {

namespace {

// 11 bits a digit: 2048 counters stay in the first-level cache, and 33 bits take three passes.
constexpr int digit_bits = 11;
constexpr std::size_t digits = std::size_t{1} << digit_bits;

template <class Item, class KeyOf>
void sort_by(std::vector<Item>& items, int low, int high, KeyOf key_of) {
  const std::size_t count = items.size();
  const auto other = std::make_unique_for_overwrite<Item[]>(count);
  Item* from = items.data();
  Item* to = other.get();
  for (int shift = low; shift < high; shift += digit_bits) {
    const std::uint64_t mask = (std::uint64_t{1} << std::min(digit_bits, high - shift)) - 1;
    std::array<std::size_t, digits> start{};
    for (std::size_t i = 0; i < count; ++i) ++start[key_of(from[i]) >> shift & mask];
    std::size_t sum = 0;
    for (std::size_t& place : start) sum += std::exchange(place, sum);
    for (std::size_t i = 0; i < count; ++i) to[start[key_of(from[i]) >> shift & mask]++] = from[i];
    std::swap(from, to);
  }
  if (from != items.data()) std::copy(from, from + count, items.data());
}

}  // namespace

void radix_sort(std::vector<Keyed>& items, int bits) {
  sort_by(items, 0, bits, [](const Keyed& item) { return item.key; });
}

void radix_sort(std::vector<std::uint64_t>& words, int low, int high) {
  sort_by(words, low, high, [](std::uint64_t word) { return word; });
}

}  // namespace vorotool::core::base
