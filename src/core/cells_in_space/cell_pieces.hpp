// The faces of cells in space, each cell by itself.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/cells_in_space/sphere_centers.hpp"

namespace vorotool::core::cells_in_space {

// One face of a cell, its corners in those of the piece: tetrahedra, or -1 - k for vertex k on the box of the piece.
struct PieceFace {
  std::int32_t cell, across;  // across: a point, or -1 - side
  std::uint32_t begin, end;
};

// What some points have: all faces of cells that were cut, of the others those towards greater points.
struct Piece {
  std::vector<PieceFace> faces;
  std::vector<std::int32_t> corners;
  std::vector<Point3> places;     // of vertices on the box
  std::vector<SideSet> sides;     // on which each is
  std::int32_t first_vertex = 0;  // the number of the first of them

  bool is_on_box(const PieceFace& face) const {
    return std::any_of(corners.begin() + face.begin, corners.begin() + face.end,
                       [](std::int32_t v) { return v < 0; });
  }
};

// Of the points in intervals, one after the other.
std::vector<Piece> cell_pieces(const SpaceMesh& mesh, const Box3& box, const SphereCenters& spheres,
                               unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::cells_in_space
