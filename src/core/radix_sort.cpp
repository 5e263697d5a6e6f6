#include "core/radix_sort.hpp"

#include <array>

namespace vorotool::core {

namespace {

// 11 bits a digit: 2048 counters stay in the first-level cache, and 33 bits take three passes.
constexpr int digit_bits = 11;
constexpr std::size_t digits = std::size_t{1} << digit_bits;

void sort_by_digit(const std::vector<Keyed>& from, std::vector<Keyed>& to, int shift) {
  std::array<std::size_t, digits> start{};
  for (const Keyed& item : from) ++start[item.key >> shift & (digits - 1)];
  std::size_t sum = 0;
  for (std::size_t& count : start) {
    const std::size_t here = count;
    count = sum;
    sum += here;
  }
  for (const Keyed& item : from) to[start[item.key >> shift & (digits - 1)]++] = item;
}

}  // namespace

void radix_sort(std::vector<Keyed>& items, int bits) {
  std::vector<Keyed> other(items.size());
  for (int shift = 0; shift < bits; shift += digit_bits) {
    sort_by_digit(items, other, shift);
    items.swap(other);
  }
}

}  // namespace vorotool::core
