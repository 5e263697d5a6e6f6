// Sets of numbers that are joined (union-find).
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace vorotool::core {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  // The smallest number of the set: what joins are made in which order does not matter.
  std::int32_t find(std::int32_t i) {
    while (parent(i) != i) i = parent(i) = parent(parent(i));  // halves the path
    return i;
  }

  void join(std::int32_t i, std::int32_t j) {
    i = find(i);
    j = find(j);
    (i < j ? parent(j) : parent(i)) = i < j ? i : j;
  }

 private:
  std::int32_t& parent(std::int32_t i) { return parent_[static_cast<std::size_t>(i)]; }

  std::vector<std::int32_t> parent_;
};

}  // namespace vorotool::core
