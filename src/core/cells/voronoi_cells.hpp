// Voronoi cells of a Delaunay triangulation, clipped to a rectangle.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/delaunay/triangulation.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::cells {

// left < right, bottom < top.
struct Box {
  double left, bottom, right, top;
};

struct VoronoiCells {
  // Ring after ring, counter-clockwise from the lexicographically smallest
  base::LargeArray<kernel::Point> vertices;
  std::vector<std::int64_t> starts;  // [n + 1] of the ring of each point in `vertices`; a ring may be empty
};

// The cell of each point: the part of the frame that is nearest to it.
//
// Which vertices a cell has is decided exactly, and each is the place nearest to the exact one that doubles
// hold: cells that share a vertex have it bit for bit. A ring is empty where the cell has no area in the
// frame or where, rounded, it has none, and of a point that lies on an earlier one. The triangulation must be
// one (verify_triangulation); throws std::invalid_argument where it is found not to be.
VoronoiCells voronoi_cells(const delaunay::TriangulationArrays& mesh, const Box& frame, unsigned threads,
                           const base::Monitor& monitor);

}  // namespace vorotool::core::cells
