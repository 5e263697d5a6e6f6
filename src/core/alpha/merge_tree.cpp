#include "core/alpha/merge_tree.hpp"

#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/indices.hpp"

namespace vorotool::core::alpha {

using base::at;

namespace {

constexpr std::int32_t never = std::numeric_limits<std::int32_t>::max();

}  // namespace

MergeTree::MergeTree(std::size_t members)
    : parent_(members), size_(members, 1), at_(members, never), next_(members, -1), last_(members) {
  std::iota(parent_.begin(), parent_.end(), 0);
  std::iota(last_.begin(), last_.end(), 0);
}

std::int32_t MergeTree::root(std::int32_t a) const {
  while (parent_[at(a)] != a) a = parent_[at(a)];
  return a;
}

bool MergeTree::join(std::int32_t a, std::int32_t b) {
  a = root(a);
  b = root(b);
  if (a == b) return false;
  if (size_[at(a)] < size_[at(b)]) std::swap(a, b);
  parent_[at(b)] = a;
  at_[at(b)] = joins_++;
  size_[at(a)] += size_[at(b)];
  next_[at(last_[at(a)])] = b;
  last_[at(a)] = last_[at(b)];
  return true;
}

// Joins get later on the way up: the one that was joined earlier goes on.
std::int32_t MergeTree::joined_at(std::int32_t a, std::int32_t b) const {
  std::int32_t latest = -1;
  while (a != b) {
    if (at_[at(a)] > at_[at(b)]) std::swap(a, b);
    if (at_[at(a)] == never) return -1;
    latest = at_[at(a)];
    a = parent_[at(a)];
  }
  return latest;
}

std::vector<std::int32_t> MergeTree::order() const {
  std::vector<std::int32_t> place(parent_.size());
  std::int32_t count = 0;
  for (std::size_t i = 0; i < parent_.size(); ++i) {
    if (at(parent_[i]) != i) continue;
    for (auto member = static_cast<std::int32_t>(i); member >= 0; member = next_[at(member)])
      place[at(member)] = count++;
  }
  return place;
}

}  // namespace vorotool::core::alpha
