// Parts of a graph that no single node holds together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/indices.hpp"

namespace vorotool::core::graphs {

// For each edge the number of its biconnected component: two edges are in the same one if there is a cycle
// through both that visits no node twice. Edges may be parallel; none may join a node with itself. (Hopcroft
// and Tarjan, "Efficient algorithms for graph manipulation", 1973.)
std::vector<std::int32_t> biconnected_components(std::size_t nodes, std::span<const base::IndexPair> edges);

}  // namespace vorotool::core::graphs
