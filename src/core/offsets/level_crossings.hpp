// Where curves at one distance from sites cross the edges of their Voronoi diagram.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"
#include "core/offsets/level_set.hpp"
#include "core/offsets/outer_components.hpp"
#include "core/offsets/polygon_faces.hpp"

namespace vorotool::core::offsets {

// Half-edges on which the clearance falls to the level, each with the place where it does. The curve, what is
// near on its left, comes there through the cell on the left and goes on into the one on the right.
class LevelCrossings {
 public:
  LevelCrossings(const HalfEdges& borders, const PolygonFaces& domain, const LevelSet& level,
                 OuterComponents& far, const base::Monitor& monitor);

  const std::vector<HalfEdge>& all() const { return all_; }
  bool has(HalfEdge h) const { return number_[static_cast<std::size_t>(h)] >= 0; }
  std::size_t number(HalfEdge h) const {
    return static_cast<std::size_t>(number_[static_cast<std::size_t>(h)]);
  }
  kernel::Point& place(HalfEdge h) { return places_[number(h)]; }
  // Whether that is where the half-edge ends, as far as doubles tell.
  bool is_at_head(HalfEdge h) const {
    const std::int32_t head = borders_.head(h);
    return head >= 0 && places_[number(h)] == borders_.diagram().vertices[static_cast<std::size_t>(head)];
  }

  // From which half-edge at the same place the curve that comes along one goes on: the same, but where what
  // is far touches itself.
  HalfEdge onward(HalfEdge h) const { return onward_[number(h)]; }

  // Where a curve comes out of the cell that it goes into from a half-edge.
  HalfEdge across_cell(HalfEdge h) const;

 private:
  void part_touching(const LevelSet& level, OuterComponents& far, bool shapes_are_near);

  const HalfEdges& borders_;
  std::vector<std::int32_t> number_;  // [half-edges] in the lists that follow, -1: it does not descend
  std::vector<HalfEdge> all_;
  std::vector<kernel::Point> places_;
  std::vector<HalfEdge> onward_;
};

}  // namespace vorotool::core::offsets
