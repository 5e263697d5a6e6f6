// Sets that are joined and never parted (union-find).
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace vorotool::core::base {

// Of numbers of an integer type.
template <class Index = std::uint32_t>
class DisjointSets {
 public:
  // 0 ... count - 1, each a set of its own.
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }

  // The smallest member of a set, whatever the order in which sets were joined; paths are halved on the way.
  Index find(Index i) {
    while (parent(i) != i) i = parent(i) = parent(parent(i));
    return i;
  }

  // Whether they were two sets before.
  bool join(Index i, Index j) {
    i = find(i);
    j = find(j);
    if (i == j) return false;
    parent(i < j ? j : i) = i < j ? i : j;
    return true;
  }

 private:
  Index& parent(Index i) { return parent_[static_cast<std::size_t>(i)]; }

  std::vector<Index> parent_;  // never greater than the member itself
};

}  // namespace vorotool::core::base
