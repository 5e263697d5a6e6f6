// Where the edges of a triangulation are in its triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "core/delaunay/triangulation.hpp"

namespace vorotool::core::proximity {

// [e] of each edge a side of a triangle, 3 t + k for that opposite to corner k; -1 where there is no triangle.
// Throws std::invalid_argument if the sides of triangles are not the edges, and for indices that do not
// exist.
std::vector<std::int32_t> edge_sides(const delaunay::TriangulationArrays& mesh);

}  // namespace vorotool::core::proximity
