// Shortest paths in a graph of arcs with lengths.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/groups.hpp"
#include "core/base/indices.hpp"
#include "core/base/monitor.hpp"

namespace vorotool::core::graphs {

// Lengths as whole numbers, in units of the power of two that brings the sum of a group between 2^60 and
// 2^61: no order of addition changes a sum of them, and the sum of all and as many halves stays below 2^62.
std::vector<std::int64_t> whole_lengths(std::span<const double> lengths, std::span<const std::int32_t> group,
                                        std::size_t groups);

// The arcs at each node, by their numbers.
using GraphIncidence = base::Groups<std::int32_t>;

// Of those arcs that `uses` says; all if it is empty.
GraphIncidence arcs_at_nodes(std::span<const base::IndexPair> arcs, std::size_t nodes,
                             const std::vector<bool>& uses = {});

struct GraphPath {
  std::vector<std::int32_t> nodes;  // one more than arcs; empty if there is no path
  std::vector<std::int32_t> arcs;
};

// Shortest paths from one place (Dijkstra). Of several equal ones those with the smallest arcs last.
class ShortestPaths {
 public:
  ShortestPaths(std::span<const base::IndexPair> arcs, std::span<const std::int64_t> lengths,
                const GraphIncidence& incidence, std::size_t nodes);

  // A node, or each end of the arc that the place is on, at a distance from it.
  struct Start {
    std::int32_t node;
    std::int64_t distance;
  };

  // Forgets what was found before, in time that what it reached took.
  void find(std::span<const Start> starts, const base::Monitor& monitor);

  static constexpr std::int64_t unreached = -1;
  std::int64_t distance(std::int32_t node) const { return distance_[static_cast<std::size_t>(node)]; }
  const std::vector<std::int32_t>& reached() const { return reached_; }
  GraphPath path_to(std::int32_t node) const;

 private:
  void reach(std::int32_t node, std::int64_t distance, std::int32_t arc);

  std::span<const base::IndexPair> arcs_;
  std::span<const std::int64_t> lengths_;
  const GraphIncidence& incidence_;
  std::vector<std::int64_t> distance_;
  std::vector<std::int32_t> last_;     // the arc by which a node is reached; -1 of starts
  std::vector<std::int32_t> reached_;  // nodes
  std::vector<Start> queue_;
};

}  // namespace vorotool::core::graphs
