// Sets that are joined and never parted (union-find).
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace vorotool::core {

class DisjointSets {
 public:
  // 0 ... count - 1, each a set of its own.
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  // The smallest member of a set; paths are halved on the way.
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }

  // Whether they were two sets before.
  bool join(std::uint32_t i, std::uint32_t j) {
    i = find(i);
    j = find(j);
    if (i == j) return false;
    parent_[i < j ? j : i] = i < j ? i : j;
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;  // never greater than the member itself
};

}  // namespace vorotool::core
