// Colors for the vertices of a graph, such that neighbors never share one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"

namespace vorotool::core::graphs {

struct Edge {
  std::uint32_t a;
  std::uint32_t b;
};

// Returns a color 1, 2, ... for each of `vertices` vertices. Edges join two different vertices, each pair
// once.
//
// Vertices are colored in smallest-last order (D. W. Matula and L. L. Beck, "Smallest-last ordering and
// clustering and graph coloring algorithms", J. ACM 30, 1983): each has at most d colored neighbors, d the
// degeneracy. It takes, of the colors in use that no neighbor has, the one used least so far, then the
// smallest; a new color only when there is none. So there are at most d + 1 colors: at most 6 for a planar
// graph, which connected regions give. Deterministic. Time O(vertices * colors + edges).
std::vector<std::uint32_t> color_graph(std::size_t vertices, std::span<const Edge> edges,
                                       const base::Monitor& monitor);

}  // namespace vorotool::core::graphs
