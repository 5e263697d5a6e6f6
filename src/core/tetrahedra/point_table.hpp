// What is told of each point of a Delaunay triangulation of space.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/tetrahedra/point3.hpp"

namespace vorotool::core::tetrahedra {

struct PointTable {
  std::vector<std::int32_t> neighbors;  // how many
  std::vector<double> cell_volume;      // infinite on the hull
  std::vector<std::int32_t> nearest;    // the nearest other point; -1 of points of no tetrahedron
  std::vector<std::uint8_t> on_hull;
};

// The tetrahedra are a Delaunay triangulation. Cells have volumes within 2^-40 of themselves. Distances are compared
// exactly, ties go to the smallest label and the smallest index. Throws std::invalid_argument for a corner that is no
// point, or a neighbor that is no tetrahedron.
PointTable point_table(std::span<const Point3> points,
                       std::span<const std::array<std::int32_t, 4>> tetrahedra,
                       std::span<const std::array<std::int32_t, 4>> neighbors,
                       std::span<const std::int64_t> labels, unsigned threads, const base::Monitor& monitor);

// The nearest other point of each among the corners of its simplices: edges or triangles.
template <std::size_t corners>
std::vector<std::int32_t> nearest_corners(std::span<const Point3> points,
                                          std::span<const std::array<std::int32_t, corners>> simplices,
                                          std::span<const std::int64_t> labels, unsigned threads,
                                          const base::Monitor& monitor);

}  // namespace vorotool::core::tetrahedra
