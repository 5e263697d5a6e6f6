// Voronoi cells of points in space, clipped to a box.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/cells_in_space/polyhedra.hpp"

namespace vorotool::core::cells_in_space {

struct SpaceMesh {
  using Row = std::array<std::int32_t, 4>;

  std::span<const Point3> points;
  std::span<const Row> tetrahedra, neighbors;          // as core/tetrahedra has them
  std::span<const std::array<std::int32_t, 2>> edges;  // of points without tetrahedra, else not used
  std::span<const std::int32_t> first;                 // [points] the first point at the same place
};

struct SpaceCells {
  std::vector<Point3> vertices;
  std::vector<std::int64_t> face_starts{0};  // [faces + 1] of each face in `corners`
  std::vector<std::int32_t>
      corners;  // counter-clockwise as seen from outside the first cell, the least vertex first
  std::vector<std::array<std::int32_t, 2>>
      face_cells;  // the cells on both sides, the smaller first, or -1 - side of the box
  std::vector<std::int64_t> cell_starts;  // [points + 1] of each cell in `cell_faces`
  std::vector<std::int32_t> cell_faces;   // faces by the cells across, then the sides of the box
};

// The cell of each point: the part of the box that is nearest to it.
//
// Which vertices, edges and faces a cell has is decided exactly; a vertex is the place nearest to the exact one that
// doubles hold. Faces have area: cells that only touch in a line or a point have none in common, and a point has no
// faces if its cell has no volume in the box or if it lies on an earlier point. Vertices are one where the exact places
// are. The triangulation must be one; throws std::invalid_argument where it is found not to be.
SpaceCells space_cells(const SpaceMesh& mesh, const Box3& box, unsigned threads,
                       const base::Monitor& monitor);

}  // namespace vorotool::core::cells_in_space
