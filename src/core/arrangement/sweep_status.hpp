// The segments that a sweep line cuts, in order from below: a list that is searched through a balanced tree.
#pragma once

#include <cstdint>
#include <vector>

namespace vorotool::core::arrangement {

// A treap whose priorities are a fixed hash of the place in memory, so that its shape, and with it the time,
// repeats. Places are stable: a segment is found again, replaced or followed by another without a search.
class SweepStatus {
 public:
  static constexpr std::int32_t none = -1;

  // The segment at a place. It may be replaced where that keeps the order.
  std::int32_t& segment(std::int32_t place) { return nodes_[static_cast<std::size_t>(place)].segment; }
  std::int32_t below(std::int32_t place) const { return node(place).below; }
  std::int32_t above(std::int32_t place) const { return node(place).above; }

  struct Found {
    std::int32_t at;     // a segment through the point, or none
    std::int32_t below;  // else the one next below it, or none
    std::int32_t above;  // and next above it
  };

  // `side(segment)` is 1 if the point is above the segment, -1 below it, 0 on it.
  template <class Side>
  Found find(Side side) const {
    std::int32_t at = root_, low = none, high = none;
    while (at != none) {
      const Node& here = node(at);
      const int where = side(here.segment);
      if (where == 0) return {at, none, none};
      (where > 0 ? low : high) = at;
      at = where > 0 ? here.right : here.left;
    }
    return {none, low, high};
  }

  // Puts a segment between two neighbors in the list, either of which may be none. Returns its place.
  std::int32_t insert(std::int32_t segment, std::int32_t below, std::int32_t above);
  void erase(std::int32_t place);

 private:
  struct Node {
    std::int32_t segment;
    std::int32_t parent, left, right;
    std::int32_t below, above;
    std::uint32_t priority;
  };

  Node& node(std::int32_t place) { return nodes_[static_cast<std::size_t>(place)]; }
  const Node& node(std::int32_t place) const { return nodes_[static_cast<std::size_t>(place)]; }
  std::int32_t new_place();
  void replace_child(std::int32_t parent, std::int32_t old_child, std::int32_t child);
  void lift(std::int32_t place);

  std::vector<Node> nodes_;
  std::vector<std::int32_t> free_;
  std::int32_t root_ = none;
};

}  // namespace vorotool::core::arrangement
