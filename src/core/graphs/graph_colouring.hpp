// Colours for the vertices of a graph, such that neighbours never share one.
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

// Returns a colour 1, 2, ... for each of `vertices` vertices. Edges join two different vertices, each pair
// once.
//
// Vertices are coloured in smallest-last order (D. W. Matula and L. L. Beck, "Smallest-last ordering and
// clustering and graph coloring algorithms", J. ACM 30, 1983): each has at most d coloured neighbours, d the
// degeneracy. It takes, of the colours in use that no neighbour has, the one used least so far, then the
// smallest; a new colour only when there is none. So there are at most d + 1 colours: at most 6 for a planar
// graph, which connected regions give. Deterministic. Time O(vertices * colours + edges).
std::vector<std::uint32_t> colour_graph(std::size_t vertices, std::span<const Edge> edges,
                                        const base::Monitor& monitor);

}  // namespace vorotool::core::graphs
