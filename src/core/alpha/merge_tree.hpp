// In which order the members of a set were joined: what the union-find structure itself forgets.
#pragma once

#include <cstdint>
#include <vector>

namespace vorotool::core::alpha {

// Members are 0 ... n - 1, joins are numbered in their order. Of each two sets the smaller becomes part of the
// larger, so that ways up are logarithmic.
class MergeTree {
 public:
  explicit MergeTree(std::size_t members);

  // Whether they were two sets before: then the join counts, with the next number.
  bool join(std::int32_t a, std::int32_t b);
  std::int32_t joins() const { return joins_; }

  // The join at which both came into one set, or -1 if they are in two.
  std::int32_t joined_at(std::int32_t a, std::int32_t b) const;

  // [n] the place of each member in an order in which every set that ever was lies side by side.
  std::vector<std::int32_t> order() const;

 private:
  std::int32_t root(std::int32_t a) const;

  std::vector<std::int32_t> parent_, size_;
  std::vector<std::int32_t> at_;           // the join by which it got its parent
  std::vector<std::int32_t> next_, last_;  // lists of the members of each set
  std::int32_t joins_ = 0;
};

}  // namespace vorotool::core::alpha
