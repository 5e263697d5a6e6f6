// Delaunay triangulation of points in the plane (paper, section 2.1).
//
// Cocircular points: each cocircular polygon is a fan from its lexicographically smallest vertex. The result depends on
// the points alone: permuting them permutes their numbers, and the order of triangles and edges stays.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/monitor.hpp"
#include "core/predicates.hpp"

namespace vorotool::core {

struct Triangulation {
  std::vector<std::int32_t> first;       // [n] the first point at the same place; itself if it is the only one
  std::vector<std::int32_t> triangles;   // [3 t] vertices, counter-clockwise
  std::vector<std::int32_t> neighbours;  // [3 t] triangle across the side opposite to the vertex, -1 on the hull
  std::vector<std::int32_t> edges;       // [2 e] ends of each edge; of fewer than three or collinear points, a chain
  std::vector<std::int32_t> hull;        // [h] vertices on the hull, counter-clockwise; of a chain, from end to end
};

// Finite points. Throws std::length_error for more than 2^28 of them.
Triangulation triangulate(std::span<const Point> points, unsigned threads, const Monitor& monitor);

}  // namespace vorotool::core
