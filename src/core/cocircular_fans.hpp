// One triangulation among the many of cocircular points.
#pragma once

#include <span>
#include <vector>

#include "core/half_edges.hpp"
#include "core/monitor.hpp"
#include "core/predicates.hpp"

namespace vorotool::core {

// Makes every cocircular polygon of a Delaunay triangulation a fan from its lexicographically smallest
// vertex. `outer` tells which half-edges have the unbounded face on their left.
void make_fans(HalfEdges& edges, const std::vector<bool>& outer, std::span<const Point> points,
               unsigned threads, const Monitor& monitor);

}  // namespace vorotool::core
