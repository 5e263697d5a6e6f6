// A check of Voronoi cells that knows the sites and the rings only, not how they were made.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/fault.hpp"
#include "core/base/monitor.hpp"
#include "core/cells/voronoi_cells.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::cells {

struct CellRings {
  std::span<const kernel::Point> sites;     // [n] finite
  std::span<const kernel::Point> vertices;  // ring after ring; finite
  std::span<const std::int64_t> starts;     // [n + 1] from 0 to the number of vertices, not decreasing
};

// What is wrong, in words: a ring that is not convex or not in the frame, a vertex nearer to another site, a
// duplicate with a cell, or areas that do not add up to that of the frame. Vertices may be off by half a unit
// in the last place of each coordinate; nothing else is allowed for.
base::Fault find_cell_fault(const CellRings& cells, const Box& frame, unsigned threads,
                            const base::Monitor& monitor);

}  // namespace vorotool::core::cells
