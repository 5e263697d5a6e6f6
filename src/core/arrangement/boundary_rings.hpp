// The rings that bound each polygon in a planar graph: polygons as they are used, after all repairs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/arrangement/face_polygons.hpp"
#include "core/kernel/lattice.hpp"

namespace vorotool::core::arrangement {

struct BoundaryGraph {
  std::span<const kernel::LatticePoint> points;
  std::span<const std::int32_t> segments;       // [2 m]
  std::span<const std::int32_t> segment_faces;  // [2 m] left and right
  std::span<const std::int32_t> face_start, face_polygon;
};

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

BoundaryRings find_boundary_rings(const BoundaryGraph& graph);

}  // namespace vorotool::core::arrangement
