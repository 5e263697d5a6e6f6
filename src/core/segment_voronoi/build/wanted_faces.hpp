// Which sites of a segment Voronoi diagram have neighbours in faces that are not asked for.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/kernel/lattice.hpp"

namespace vorotool::core::segment_voronoi::build {

// Bits of a site: its cell is unwanted left or right of it. The cell of a point is in one face, and has both
// or none.
enum UnwantedSide : std::uint8_t { unwanted_left = 1, unwanted_right = 2 };

// [n] the face in which the cell of each point lies: that of its sector over 180 degrees; -1 for a point
// without segments. A point whose segments leave no such sector has no cell, and what stands there is never
// asked for. `segment_faces` are those left and right of each segment.
std::vector<std::int32_t> point_faces(std::span<const kernel::LatticePoint> points,
                                      std::span<const std::array<std::int32_t, 2>> segments,
                                      std::span<const std::array<std::int32_t, 2>> segment_faces);

// [n + m] of points, then segments, where only faces that are wanted are asked for. Points without segments
// are in none.
std::vector<std::uint8_t> unwanted_sides(std::span<const kernel::LatticePoint> points,
                                         std::span<const std::array<std::int32_t, 2>> segments,
                                         std::span<const std::array<std::int32_t, 2>> segment_faces,
                                         std::span<const std::uint8_t> is_wanted);

}  // namespace vorotool::core::segment_voronoi::build
