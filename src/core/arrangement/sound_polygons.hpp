// Whether polygons with coordinates in doubles are valid as they stand, and together a coverage.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::arrangement {

// Rings one after the other, those of a polygon its shell and then its holes.
struct PolygonRings {
  std::span<const kernel::Point> points;        // finite
  std::span<const std::int64_t> ring_start;     // [r + 1] first vertex
  std::span<const std::int64_t> polygon_start;  // [p + 1] first ring
};

// What is not seen to be right of a polygon: the bits of a byte.
inline constexpr std::uint8_t unsound = 1, clashes = 2;

// A polygon is sound that has one ring of three vertices or more, which runs counter-clockwise, and whose edges
// meet where one ends and the next begins and nowhere else. In a coverage a polygon clashes with another one if
// both have an edge in the same direction, or if edges of theirs that no polygon has in the opposite direction
// meet elsewhere than at a common end. Every sign is exact.
//
// If the rings of a coverage fit together as those of a subdivision of the plane do, all are sound and none
// clashes, then no two polygons overlap: the winding numbers of all rings, each 0 or 1, add up to that of the
// outline, which is 0 or 1 everywhere.
std::vector<std::uint8_t> find_polygon_faults(const PolygonRings& rings, bool is_coverage, unsigned threads,
                                              const base::Monitor& monitor);

}  // namespace vorotool::core::arrangement
