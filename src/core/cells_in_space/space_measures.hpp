// Areas and volumes of cells in space.
#pragma once

#include <vector>

#include "core/base/monitor.hpp"
#include "core/cells_in_space/polyhedra.hpp"

namespace vorotool::core::cells_in_space {

struct SpaceMeasures {
  std::vector<double> face_areas, volumes, areas;
};

// The error of a volume is about 2^-49 times the cube of the diameter of the cell.
SpaceMeasures measure_space_cells(const CellFaces& cells, unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::cells_in_space
