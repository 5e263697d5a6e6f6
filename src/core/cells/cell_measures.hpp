// Areas and lengths of cells.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/cells/voronoi_cells.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::cells {

struct CellOutlines {
  std::span<const kernel::Point> sites;      // [n]
  std::span<const kernel::Point> vertices;   // ring after ring; outer ones counter-clockwise, holes clockwise
  std::span<const std::int64_t> rings;       // [r + 1] where each begins; none is empty
  std::span<const std::int64_t> cell_rings;  // [n + 1] the first ring of each cell
};

// Of an empty cell all is zero.
struct CellMeasures {
  explicit CellMeasures(std::size_t cells)
      : area(cells, 0), perimeter(cells, 0), reach(cells, 0), touches_frame(cells, 0) {}

  std::vector<double> area, perimeter;
  std::vector<double> reach;                // distance of the farthest vertex from the site
  std::vector<std::uint8_t> touches_frame;  // whether a vertex lies on the frame
};

// The arrays must go together. Errors of areas are about 2^-50 times the square of a ring's diameter.
CellMeasures measure_cells(const CellOutlines& cells, const Box& frame, unsigned threads,
                           const base::Monitor& monitor);

}  // namespace vorotool::core::cells
