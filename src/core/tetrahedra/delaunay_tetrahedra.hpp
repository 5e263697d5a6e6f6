// Delaunay triangulation of points in space.
//
// Cospherical points are divided as the rule of predicates.hpp says: the result depends on the points alone. Permuting
// them permutes their numbers, and the order of the tetrahedra stays.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/tetrahedra/point3.hpp"

namespace vorotool::core::tetrahedra {

struct Tetrahedra {
  // 3, or less where all points are coplanar (2), collinear (1), one (0), or there are none (-1): no tetrahedra then.
  int dimension = -1;
  std::size_t count = 0;
  // [count] points of each, positive in their order. The first is the first along a Hilbert curve, the second the first
  // of the others; rows are sorted by these, and by the third.
  base::LargeArray<std::array<std::int32_t, 4>> vertices;
  // [count] the tetrahedron across the facet opposite to each vertex, or -1
  base::LargeArray<std::array<std::int32_t, 4>> neighbors;
  std::vector<std::int32_t> first;  // [points] the first point at the same place
  std::size_t duplicates = 0;       // points that have an earlier one at the same place
};

// Finite points. Throws std::length_error where there are more than 2^28, TooManyTetrahedra (tetrahedral_mesh.hpp) where
// there are more than 2^29 of these, or than memory holds.
Tetrahedra triangulate(std::span<const Point3> points, unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::tetrahedra
