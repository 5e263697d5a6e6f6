// What a graph is without its trees: chains of arcs between junctions, and the farthest pairs of what hangs
// there.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/monitor.hpp"
#include "core/graphs/shortest_paths.hpp"

namespace vorotool::core::graphs {

// Two leaves, and the nodes at which the shortest path between them enters and leaves the core: one and the
// same if it has no arc there.
struct LeafPair {
  std::int64_t length = -1;
  std::int32_t first = -1, last = -1;  // leaves, first < last
  std::int32_t first_node = -1, last_node = -1;

  bool is_better_than(const LeafPair& other) const;
};

// The longest path from a node to a leaf of the trees attached to it.
struct Hanging {
  std::int64_t depth = -1;
  std::int32_t leaf = -1;   // none: nothing hangs there
  std::int32_t leaves = 0;  // that hang there
};

LeafPair leaf_pair(const Hanging& a, std::int32_t a_node, const Hanging& b, std::int32_t b_node,
                   std::int64_t between);

// The best pair of each component of a core, whose arcs are those of `core`. In a component at which nothing
// hangs each node is a leaf; a single leaf makes pairs with the nodes.
std::vector<LeafPair> farthest_pairs(std::span<const base::IndexPair> arcs,
                                     std::span<const std::int64_t> lengths, const GraphIncidence& core,
                                     std::span<const Hanging> hanging, const base::Monitor& monitor);

}  // namespace vorotool::core::graphs
