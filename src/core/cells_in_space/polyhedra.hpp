// Polyhedra that fill a box, as arrays.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/tetrahedra/point3.hpp"

namespace vorotool::core::cells_in_space {

using tetrahedra::Point3;

// Less than high along each axis.
struct Box3 {
  Point3 low, high;
};

constexpr std::size_t box_sides = 6;  // low x, high x, low y, high y, low z, high z

// The faces of cells; indices are in range.
struct CellFaces {
  std::span<const Point3> vertices;
  std::span<const std::int64_t> face_starts;  // [faces + 1] of each face in `corners`
  std::span<const std::int32_t> corners;      // counter-clockwise as seen from outside the first cell
  std::span<const std::array<std::int32_t, 2>> face_cells;  // on both sides, the smaller first, or -1 - side
  std::span<const std::int64_t> cell_starts;                // [cells + 1] of each cell in `cell_faces`
  std::span<const std::int32_t> cell_faces;                 // by the cells across, then the sides of the box

  std::span<const std::int32_t> face(std::size_t f) const {
    const auto begin = static_cast<std::size_t>(face_starts[f]);
    return corners.subspan(begin, static_cast<std::size_t>(face_starts[f + 1]) - begin);
  }
  std::span<const std::int32_t> cell(std::size_t i) const {
    const auto begin = static_cast<std::size_t>(cell_starts[i]);
    return cell_faces.subspan(begin, static_cast<std::size_t>(cell_starts[i + 1]) - begin);
  }
};

}  // namespace vorotool::core::cells_in_space
