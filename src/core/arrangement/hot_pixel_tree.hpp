// A k-d tree over lattice points that gives those whose cells a segment meets. Its boxes are met by segments,
// and its items have no labels that break ties: with KdTree (core/spatial) it has the halving of a range at
// its median in common, eight lines that a shared one would need parameters for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/arrangement/rational_point.hpp"

namespace vorotool::core::arrangement {

class HotPixelTree {
 public:
  explicit HotPixelTree(std::span<const kernel::LatticePoint> points);

  // Calls visit(i) for every point whose cell the segment meets (meets_cell), in no particular order, until
  // it returns false.
  template <class Visit>
  void visit_met(const LatticeSegment& segment, Visit visit) const {
    if (!items_.empty()) descend(0, 0, items_.size(), segment, visit);
  }

 private:
  static constexpr std::size_t leaf_size = 8;

  struct Item {
    kernel::LatticePoint point;
    std::int32_t index;
  };
  struct Box {
    kernel::LatticePoint low, high;
  };

  void build(std::size_t node, std::size_t begin, std::size_t end);
  static bool may_meet(const Box& box, const LatticeSegment& segment);

  template <class Visit>
  bool descend(std::size_t node, std::size_t begin, std::size_t end, const LatticeSegment& segment,
               Visit& visit) const {
    if (!may_meet(boxes_[node], segment)) return true;
    if (end - begin <= leaf_size) {
      for (std::size_t i = begin; i < end; ++i) {
        if (meets_cell(segment, items_[i].point) && !visit(items_[i].index)) return false;
      }
      return true;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    return descend(2 * node + 1, begin, middle, segment, visit) &&
           descend(2 * node + 2, middle, end, segment, visit);
  }

  std::vector<Item> items_;
  std::vector<Box> boxes_;  // of the points under each node, a heap: children of k are 2 k + 1 and 2 k + 2
};

}  // namespace vorotool::core::arrangement
