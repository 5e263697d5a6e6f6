// Which sites of a segment Voronoi diagram have neighbors in faces that are not asked for.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/kernel/planar_graph_view.hpp"

namespace vorotool::core::segment_voronoi::build {

// Bits of a site: its cell is unwanted left or right of it. The cell of a point is in one face, and has both
// or none.
enum UnwantedSide : std::uint8_t { unwanted_left = 1, unwanted_right = 2 };

// [n] the face in which the cell of each point lies: that of its sector over 180 degrees; -1 for a point
// without segments. A point whose segments leave no such sector has no cell, and what stands there is never
// asked for.
std::vector<std::int32_t> point_faces(const kernel::PlanarGraphView& graph);

// [n + m] of points, then segments, where only faces that are wanted are asked for. Points without segments
// are in none.
std::vector<std::uint8_t> unwanted_sides(const kernel::PlanarGraphView& graph,
                                         std::span<const std::uint8_t> is_wanted);

}  // namespace vorotool::core::segment_voronoi::build
