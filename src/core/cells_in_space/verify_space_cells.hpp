// A check of Voronoi cells in space that knows the sites and the polyhedra only, not how they were made.
#pragma once

#include <span>

#include "core/base/fault.hpp"
#include "core/base/monitor.hpp"
#include "core/cells_in_space/polyhedra.hpp"

namespace vorotool::core::cells_in_space {

// What is wrong, in words. Vertices may be off by half a unit in the last place of each coordinate.
base::Fault find_space_cell_fault(std::span<const Point3> sites, const CellFaces& cells, const Box3& box,
                                  unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::cells_in_space
