// Of each point of a triangulation, the nearest other one: it is always a Delaunay neighbor.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::delaunay {

struct NearestNeighbors {
  std::vector<std::int32_t> nearest;  // [n] -1 of points without an edge
  std::vector<std::int32_t> count;    // [n] of neighbors
};

// `edges` holds both ends of each edge of a Delaunay triangulation. Distances are compared exactly, ties go
// to the smallest label. Throws std::invalid_argument for an end that is no point.
NearestNeighbors nearest_neighbors(std::span<const kernel::Point> points, std::span<const std::int32_t> edges,
                                   std::span<const std::int64_t> labels, const base::Monitor& monitor);

}  // namespace vorotool::core::delaunay
