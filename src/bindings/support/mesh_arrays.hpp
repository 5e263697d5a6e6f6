// The arrays of a triangulation as they come in from NumPy.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>

#include "bindings/support/arrays.hpp"
#include "core/delaunay/triangulation.hpp"

namespace vorotool::bindings {

using Indices = Vector<const std::int32_t>;
using IndexRows = Matrix<const std::int32_t>;

inline std::span<const core::kernel::Point> as_points(const Matrix<const double>& array) {
  if (array.shape(1) != 2) throw std::invalid_argument("points must have two columns");
  static_assert(sizeof(core::kernel::Point) == 2 * sizeof(double));
  return {reinterpret_cast<const core::kernel::Point*>(array.data()), array.shape(0)};
}

inline std::span<const std::int32_t> rows_of(const IndexRows& array, std::size_t columns) {
  if (array.shape(1) != columns)
    throw std::invalid_argument("an array of indices has a wrong number of columns");
  return view(array);
}

inline core::delaunay::TriangulationArrays mesh_arrays(const Matrix<const double>& points,
                                                       const IndexRows& triangles,
                                                       const IndexRows& neighbours,
                                                       std::span<const std::int32_t> edges,
                                                       std::span<const std::int32_t> hull,
                                                       std::span<const std::int32_t> first) {
  const core::delaunay::TriangulationArrays arrays{
      as_points(points), rows_of(triangles, 3), rows_of(neighbours, 3), edges, hull, first};
  if (arrays.first.size() != arrays.points.size() || arrays.neighbours.size() != arrays.triangles.size()) {
    throw std::invalid_argument("the arrays of a triangulation have lengths that do not go together");
  }
  return arrays;
}

// (n, 2) doubles that take over the points.
inline Array<double> points_to_numpy(core::base::LargeArray<core::kernel::Point>&& points) {
  const std::size_t rows = points.size();
  core::kernel::Point* data = points.release();
  return {reinterpret_cast<double*>(data), {rows, 2}, nanobind::capsule(data, [](void* p) noexcept {
            core::base::LargeArray<core::kernel::Point>::free(static_cast<core::kernel::Point*>(p));
          })};
}

}  // namespace vorotool::bindings
