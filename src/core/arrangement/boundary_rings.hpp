// The rings that bound each polygon in a planar graph: polygons as they are used, after all repairs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/kernel/planar_graph_view.hpp"

namespace vorotool::core::arrangement {

// Rings that visit no point twice, with the inside on their left: shells counter-clockwise, holes clockwise.
// A part is a connected region of a polygon: a shell and then its holes. Parts are sorted by polygon and then
// by the first point of their shells, holes by their first points; a ring begins with its first point. Rings
// of one part may touch each other in points, and so may parts.
struct BoundaryRings {
  std::vector<std::int32_t> start;         // [r + 1]
  std::vector<std::int32_t> point;         // along each ring
  std::vector<std::int32_t> segment;       // from each point to the next one
  std::vector<std::uint8_t> is_hole;       // [r]
  std::vector<std::int32_t> ring_part;     // [r] not decreasing
  std::vector<std::int32_t> part_polygon;  // [parts] not decreasing
};

// Face f of the graph lies in face_polygon[face_start[f]] ...
BoundaryRings find_boundary_rings(const kernel::PlanarGraphView& graph,
                                  std::span<const std::int32_t> face_start,
                                  std::span<const std::int32_t> face_polygon);

}  // namespace vorotool::core::arrangement
