// The arcs of a skeleton in a canonical order: branch by branch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/skeleton/graph.hpp"

namespace vorotool::core::skeleton {

struct OrderedArc {
  std::int32_t arc;             // of the graph
  std::int32_t source, target;  // new numbers of its nodes
  std::int32_t branch;
  bool is_reversed;
};

struct SkeletonOrder {
  std::vector<OrderedArc> arcs;
  std::vector<std::int32_t> nodes;  // the node of each new number: in the order in which arcs meet them
};

// A branch is a chain of arcs whose inner nodes have two arcs; its arcs follow each other, all in its
// direction. Groups follow each other by number. In each, branches with ends come before closed ones,
// otherwise in the order of their first arcs among those given; a branch begins at its end which that arc's
// source is nearest to.
SkeletonOrder order_by_branches(std::span<const GraphArc> arcs, std::size_t nodes,
                                const base::Monitor& monitor);

}  // namespace vorotool::core::skeleton
