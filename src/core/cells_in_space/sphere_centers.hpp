// The centers of the spheres of tetrahedra.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/cells_in_space/space_cells.hpp"

namespace vorotool::core::cells_in_space {

using SideSet = std::uint8_t;  // a bit a side

struct Center {
  Point3 place;
  SideSet beyond, on;  // sides of the box beyond which it is, or on which
};

struct SphereCenters {
  std::vector<Center> centers;     // [tetrahedra]
  std::vector<std::int32_t> sets;  // of each tetrahedron the first one with the same center
};

SphereCenters sphere_centers(const SpaceMesh& mesh, const Box3& box, unsigned threads,
                             const base::Monitor& monitor);

// Throws that the triangulation is not Delaunay.
[[noreturn]] void refuse_mesh();

}  // namespace vorotool::core::cells_in_space
