// The longest of the shortest paths between leaves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/monitor.hpp"
#include "core/graphs/shortest_paths.hpp"

namespace vorotool::core::graphs {

// For each group of arcs the longest among the shortest paths between two leaves of one component, between
// two nodes of components without a leaf, and from a single leaf to a node; from the end with the smaller
// number. Of equally long ones that whose ends have the smallest numbers; in a tree those are equally long
// that are shorter than the longest by no more than a part `tie` of it. No path where a group has no arcs.
//
// Trees take linear time. With cycles, let K be the nodes on them at which trees hang (all, where none does)
// and F the chains between nodes with three arcs on cycles: at most K searches in F chains, O(K F log K);
// what is no farther than the best by the distances found before is left out.
std::vector<GraphPath> longest_paths(std::span<const base::IndexPair> arcs,
                                     std::span<const std::int64_t> lengths,
                                     std::span<const std::int32_t> group, std::size_t groups,
                                     std::size_t nodes, double tie, const base::Monitor& monitor);

// The shortest path between two nodes, or, with last -1, the longest of the shortest paths from a node to the
// leaves of its component (to its nodes, where it has no leaf but the first). No path between components.
GraphPath path_from(std::span<const base::IndexPair> arcs, std::span<const std::int64_t> lengths,
                    std::size_t nodes, std::int32_t first, std::int32_t last, const base::Monitor& monitor);

}  // namespace vorotool::core::graphs
