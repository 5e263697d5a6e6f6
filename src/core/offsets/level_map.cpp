#include "core/offsets/level_map.hpp"

#include <limits>

#include "core/offsets/level_arcs.hpp"
#include "core/offsets/outer_components.hpp"

namespace vorotool::core::offsets {

LevelMap level_map(const HalfEdges& borders, const PolygonFaces& domain, double level,
                   const base::Monitor& monitor) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const LevelSet set(borders, level);
  OuterComponents far(borders, domain, set, monitor);
  LevelCrossings crossings(borders, domain, set, far, monitor);
  const LevelArcs arcs(borders, crossings, level);
  LevelMap map;
  for (const HalfEdge h : crossings.all()) {
    const Piece piece{h, crossings.across_cell(h)};
    map.half_edge.push_back(h);
    map.across.push_back(static_cast<std::int32_t>(crossings.number(piece.last)));
    map.ending.push_back(crossings.is_at_head(h) ? at_vertex : set.touches(h) ? touching : inside);
    map.arc.push_back(arcs.is_between_aligned(domain, piece) ? aligned
                      : arcs.is_lost(piece)                  ? lost
                                                             : ordinary);
    map.place.push_back(crossings.place(h));
    map.middle.push_back(arcs.is_long(piece) ? arcs.middle(piece) : kernel::Point{nan, nan});
  }
  for (const LevelArcs::Circle& circle : arcs.circles(domain, set)) map.circles.push_back(circle.point);
  return map;
}

}  // namespace vorotool::core::offsets
