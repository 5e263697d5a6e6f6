#include "core/offsets/inner_components.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <tuple>

namespace vorotool::core::offsets {

InnerComponents::InnerComponents(const HalfEdges& borders, const PolygonFaces& domain, const LevelSet& level,
                                 const LevelCrossings& crossings, const base::Monitor& monitor)
    : sets_(domain.site_polygon.size()) {
  const segment_voronoi::build::DiagramView& diagram = borders.diagram();
  for (std::size_t j = 0; j < diagram.segments.size(); ++j) {
    const auto segment = static_cast<std::int32_t>(diagram.points.size() + j);
    for (const std::int32_t end : diagram.segments[j]) sets_.join(segment, end);
  }
  for (HalfEdge h = 0; h < borders.size(); ++h) {
    base::report_item(monitor, static_cast<std::size_t>(h));
    if (crossings.has(h)) {
      sets_.join(borders.left(h), borders.right(crossings.onward(h)));
    } else if (!crossings.has(h ^ 1) && (!domain.holds(borders, h) || !level.is_edge_above(h))) {
      sets_.join(borders.left(h), borders.right(h));
    }
  }
}

namespace {

// A region at a ring.
struct Side {
  bool is_near;
  std::int32_t region;
  std::size_t ring;

  friend bool operator<(const Side& a, const Side& b) {
    return std::tie(a.is_near, a.region, a.ring) < std::tie(b.is_near, b.region, b.ring);
  }
};

}  // namespace

std::vector<bool> outer_rings(std::span<const RingSides> rings, std::int32_t region_at_infinity,
                              bool shapes_are_near) {
  std::vector<Side> sides;
  for (std::size_t k = 0; k < rings.size(); ++k) {
    sides.push_back({false, rings[k].far, k});
    sides.push_back({true, rings[k].near, k});
  }
  std::sort(sides.begin(), sides.end());
  std::vector<bool> is_seen(rings.size()), is_outer(rings.size());
  std::vector<Side> reached{{!shapes_are_near, region_at_infinity, 0}};
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const Side from = reached[k];
    for (auto side = std::lower_bound(sides.begin(), sides.end(), Side{from.is_near, from.region, 0});
         side != sides.end() && side->is_near == from.is_near && side->region == from.region; ++side) {
      if (is_seen[side->ring]) continue;
      is_seen[side->ring] = true;
      is_outer[side->ring] = from.is_near != shapes_are_near;
      reached.push_back({!from.is_near, from.is_near ? rings[side->ring].far : rings[side->ring].near, 0});
    }
  }
  if (reached.size() != rings.size() + 1) throw std::runtime_error("offset curves are not nested");
  return is_outer;
}

}  // namespace vorotool::core::offsets
