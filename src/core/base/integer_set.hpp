// A set of small integers that knows the neighbors of any integer in it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vorotool::core::base {

// A bit for each integer below a bound; above, a bit for each word of 64 bits that has one, and so on up to a
// single word. Every operation looks at two words a level at most: four levels reach 2^24.
class IntegerSet {
 public:
  static constexpr std::size_t none = SIZE_MAX;

  explicit IntegerSet(std::size_t bound) {
    do {
      bound = bound / 64 + 1;
      levels_.emplace_back(bound, 0);
    } while (bound > 1);
  }

  bool contains(std::size_t i) const { return (levels_[0][i / 64] >> i % 64 & 1) != 0; }

  void insert(std::size_t i) {
    for (std::vector<std::uint64_t>& words : levels_) {
      const bool was_empty = words[i / 64] == 0;
      words[i / 64] |= std::uint64_t{1} << i % 64;
      if (!was_empty) return;
      i /= 64;
    }
  }

  void erase(std::size_t i) {
    for (std::vector<std::uint64_t>& words : levels_) {
      words[i / 64] &= ~(std::uint64_t{1} << i % 64);
      if (words[i / 64] != 0) return;
      i /= 64;
    }
  }

  // The largest one below i, or none.
  std::size_t below(std::size_t i) const {
    for (std::size_t level = 0; level < levels_.size(); ++level, i /= 64) {
      const std::uint64_t lower = levels_[level][i / 64] & ((std::uint64_t{1} << i % 64) - 1);
      if (lower == 0) continue;
      i = i / 64 * 64 + highest(lower);
      while (level > 0) i = i * 64 + highest(levels_[--level][i]);
      return i;
    }
    return none;
  }

  // The smallest one above i, or none.
  std::size_t above(std::size_t i) const {
    for (std::size_t level = 0; level < levels_.size(); ++level, i /= 64) {
      const std::uint64_t upper = levels_[level][i / 64] & ~std::uint64_t{1} << i % 64;
      if (upper == 0) continue;
      i = i / 64 * 64 + lowest(upper);
      while (level > 0) i = i * 64 + lowest(levels_[--level][i]);
      return i;
    }
    return none;
  }

 private:
  static std::size_t highest(std::uint64_t word) {
    return 63 - static_cast<std::size_t>(std::countl_zero(word));
  }
  static std::size_t lowest(std::uint64_t word) { return static_cast<std::size_t>(std::countr_zero(word)); }

  std::vector<std::vector<std::uint64_t>> levels_;  // from that of the integers
};

}  // namespace vorotool::core::base
