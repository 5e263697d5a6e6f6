// A Delaunay triangulation in flat arrays, as what follows from it reads them.
#pragma once

#include <cstdint>
#include <span>

#include "core/kernel/point.hpp"

namespace vorotool::core::delaunay {

struct TriangulationArrays {
  std::span<const kernel::Point> points;    // [n] finite
  std::span<const std::int32_t> triangles;  // [3 t] counter-clockwise
  std::span<const std::int32_t> neighbors;  // [3 t] across the side opposite to each vertex; -1 on the hull
  std::span<const std::int32_t> edges;      // [2 e] the smaller index first
  std::span<const std::int32_t> hull;       // [h] counter-clockwise from the lexicographically smallest
  std::span<const std::int32_t> first;      // [n] the smallest index at the same place
};

}  // namespace vorotool::core::delaunay
