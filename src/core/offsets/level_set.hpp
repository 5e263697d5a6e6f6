// Where the clearance along the edges of a segment Voronoi diagram passes a value.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/kernel/point.hpp"
#include "core/offsets/half_edges.hpp"

namespace vorotool::core::offsets {

// A vertex is above a level if its radius is larger, as it is computed: one decision a vertex, so that
// whatever follows from several of them fits together even where radius and level are within a rounding of
// each other. Infinity is above.
//
// Along an edge the clearance is convex. It passes the level once where one end is above, and where both are
// never or twice: then it has its minimum, half the distance between the two sites, inside the edge.
class LevelSet {
 public:
  // The level is positive, in lattice units.
  LevelSet(const HalfEdges& borders, double level) : borders_(borders), level_(level) {}

  bool is_above(std::int32_t vertex) const {
    return vertex < 0 || borders_.diagram().radius[static_cast<std::size_t>(vertex)] > level_;
  }
  // Whether an edge is above as a whole.
  bool is_edge_above(HalfEdge h) const {
    return is_above(borders_.tail(h)) && is_above(borders_.head(h)) && !dips(h);
  }
  // Whether a half-edge leaves what is above: from its tail, which is, to its head or a minimum.
  bool descends(HalfEdge h) const {
    return is_above(borders_.tail(h)) && (!is_above(borders_.head(h)) || dips(h));
  }
  // Where a half-edge that descends does so.
  kernel::Point crossing(HalfEdge h) const;
  // Whether it does so at its head, which is just on the level.
  bool ends_at_head(HalfEdge h) const {
    const std::int32_t head = borders_.head(h);
    return head >= 0 && end(head).radius == level_ && minimum(h) > level_;
  }
  // Whether its minimum is just on the level, both ends above.
  bool touches(HalfEdge h) const { return is_above(borders_.head(h)) && minimum(h) == level_; }

 private:
  bool dips(HalfEdge h) const { return minimum(h) <= level_; }
  // Inside an edge whose ends are above; infinite where there is none.
  double minimum(HalfEdge h) const;
  double minimum_between_points(HalfEdge h, const kernel::LatticeSite& left,
                                const kernel::LatticeSite& right) const;
  kernel::Point crossing_between_points(HalfEdge h, const kernel::LatticeSite& left,
                                        const kernel::LatticeSite& right) const;
  kernel::Point crossing_between_segments(HalfEdge h) const;
  template <class Parameter>
  bool is_beyond_head(HalfEdge h, double crossing, const Parameter& parameter) const;
  kernel::Point beside_end(const kernel::LatticeSite& left, const kernel::LatticeSite& right) const;
  skeleton::ArcEnd end(std::int32_t vertex) const {
    const auto v = static_cast<std::size_t>(vertex);
    return {borders_.diagram().vertices[v], borders_.diagram().radius[v]};
  }

  const HalfEdges& borders_;
  double level_;
};

// Whether a site is an end of another one.
inline bool is_end_of(const kernel::LatticeSite& site, const kernel::LatticeSite& other) {
  return site.is_point() && !other.is_point() && (other.a == site.a || other.b == site.a);
}

// Whether the half-edge between a segment and its end, which leads across the end, begins on the left of the
// segment, as seen along it.
inline bool begins_left(const kernel::LatticeSite& left, const kernel::LatticeSite& right) {
  return left.is_point() ? left.a == right.b : right.a == left.a;
}

}  // namespace vorotool::core::offsets
