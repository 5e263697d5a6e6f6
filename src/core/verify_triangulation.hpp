// An exact check of a Delaunay triangulation that knows its arrays only, not how they were made.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/monitor.hpp"
#include "core/predicates.hpp"

namespace vorotool::core {

struct TriangulationArrays {
  std::span<const Point> points;             // [n] finite
  std::span<const std::int32_t> triangles;   // [3 t] counter-clockwise
  std::span<const std::int32_t> neighbours;  // [3 t] across the side opposite to each vertex; -1 on the hull
  std::span<const std::int32_t> edges;       // [2 e] the smaller index first
  std::span<const std::int32_t> hull;        // [h] counter-clockwise from the lexicographically smallest
  std::span<const std::int32_t> first;       // [n] the smallest index at the same place
};

// What is wrong, in words: the first fault of the first check that fails. Nothing if the arrays are the
// Delaunay triangulation of the points, cocircular polygons being fans from their lexicographically smallest
// vertex, or the chain of fewer than three or of collinear points.
std::optional<std::string> find_fault(const TriangulationArrays& arrays, unsigned threads,
                                      const Monitor& monitor);

}  // namespace vorotool::core
