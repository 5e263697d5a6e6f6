#include "core/longest_paths.hpp"

#include <algorithm>
#include <utility>

#include "core/core_chains.hpp"
#include "core/skeleton_forest.hpp"

namespace vorotool::core {
namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

class PathFinder {
 public:
  PathFinder(std::span<const std::array<std::int32_t, 2>> arcs, std::span<const std::int64_t> lengths,
             std::span<const std::int32_t> group, std::size_t groups, std::size_t nodes,
             const Monitor& monitor)
      : arcs_(arcs),
        lengths_(lengths),
        monitor_(monitor),
        forest_(arcs, std::vector<std::uint8_t>(nodes)),
        deepest_(nodes),
        second_(nodes),
        group_(nodes),
        best_(groups),
        core_(arcs, nodes, is_in_core()),
        paths_(arcs, lengths, core_, nodes) {
    for (std::size_t k = 0; k < arcs.size(); ++k) group_[at(arcs[k][0])] = group_[at(arcs[k][1])] = group[k];
  }

  std::vector<GraphPath> find() {
    if (monitor_ && !monitor_(0)) throw Interrupted();
    pairs_in_trees();
    if (forest_.hanging().size() < arcs_.size()) {
      for (const LeafPair& pair : farthest_pairs(arcs_, lengths_, core_, deepest_, monitor_)) consider(pair);
    }
    std::vector<GraphPath> found;
    for (const LeafPair& pair : best_) found.push_back(pair.first < 0 ? GraphPath{} : path_of(pair));
    return found;
  }

 private:
  std::vector<bool> is_in_core() const {
    std::vector<bool> is_core(arcs_.size(), true);
    for (const HangingArc& hanging : forest_.hanging()) is_core[at(hanging.arc)] = false;
    return is_core;
  }

  void consider(const LeafPair& pair) {
    LeafPair& best = best_[at(group_[at(pair.first)])];
    if (pair.is_better_than(best)) best = pair;
  }

  // The two deepest leaves on different arcs of each node are the best pair whose path turns there.
  void pairs_in_trees() {
    for (std::size_t k = 0; k < deepest_.size(); ++k) {
      const auto node = static_cast<std::int32_t>(k);
      if (forest_.degree(node) == 1) deepest_[k] = {0, node, 1};
    }
    for (const auto& [arc, outer, inner] : forest_.hanging()) {
      const Hanging& beyond = deepest_[at(outer)];
      add(inner, {beyond.depth + lengths_[at(arc)], beyond.leaf, beyond.leaves});
    }
    for (std::size_t k = 0; k < deepest_.size(); ++k) {
      const auto node = static_cast<std::int32_t>(k);
      if (second_[k].leaf >= 0) consider(leaf_pair(deepest_[k], node, second_[k], node, 0));
    }
  }

  void add(std::int32_t node, const Hanging& hanging) {
    const auto is_deeper = [](const Hanging& a, const Hanging& b) {
      return a.depth != b.depth ? a.depth > b.depth : a.leaf < b.leaf;
    };
    Hanging &first = deepest_[at(node)], &second = second_[at(node)];
    const std::int32_t leaves = first.leaves + hanging.leaves;
    if (is_deeper(hanging, first)) {
      second = std::exchange(first, hanging);
    } else if (is_deeper(hanging, second)) {
      second = hanging;
    }
    first.leaves = leaves;
  }

  GraphPath path_of(const LeafPair& pair) {
    GraphPath path = climb(pair.first, pair.first_node);
    if (pair.first_node != pair.last_node) {
      const ShortestPaths::Start start{pair.first_node, 0};
      paths_.find(std::span(&start, 1), monitor_);
      append(path, paths_.path_to(pair.last_node));
    }
    GraphPath down = climb(pair.last, pair.last_node);
    std::reverse(down.nodes.begin(), down.nodes.end());
    std::reverse(down.arcs.begin(), down.arcs.end());
    append(path, down);
    return path;
  }

  // From a leaf to a node that it hangs on.
  GraphPath climb(std::int32_t leaf, std::int32_t node) const {
    GraphPath path{{leaf}, {}};
    while (path.nodes.back() != node) {
      const HangingArc& hanging = forest_.hanging()[at(forest_.above(path.nodes.back()))];
      path.arcs.push_back(hanging.arc);
      path.nodes.push_back(hanging.inner);
    }
    return path;
  }

  // What begins where the path ends.
  static void append(GraphPath& path, const GraphPath& more) {
    path.nodes.insert(path.nodes.end(), more.nodes.begin() + 1, more.nodes.end());
    path.arcs.insert(path.arcs.end(), more.arcs.begin(), more.arcs.end());
  }

  std::span<const std::array<std::int32_t, 2>> arcs_;
  std::span<const std::int64_t> lengths_;
  const Monitor& monitor_;
  SkeletonForest forest_;
  std::vector<Hanging> deepest_, second_;  // at each node
  std::vector<std::int32_t> group_;        // of each node
  std::vector<LeafPair> best_;             // of each group
  GraphIncidence core_;
  ShortestPaths paths_;
};

}  // namespace

std::vector<GraphPath> longest_paths(std::span<const std::array<std::int32_t, 2>> arcs,
                                     std::span<const std::int64_t> lengths,
                                     std::span<const std::int32_t> group, std::size_t groups,
                                     std::size_t nodes, const Monitor& monitor) {
  return PathFinder(arcs, lengths, group, groups, nodes, monitor).find();
}

GraphPath path_from(std::span<const std::array<std::int32_t, 2>> arcs, std::span<const std::int64_t> lengths,
                    std::size_t nodes, std::int32_t first, std::int32_t last, const Monitor& monitor) {
  const GraphIncidence incidence(arcs, nodes);
  ShortestPaths paths(arcs, lengths, incidence, nodes);
  const ShortestPaths::Start start{first, 0};
  paths.find(std::span(&start, 1), monitor);
  if (last >= 0) return paths.path_to(last);
  const auto is_leaf = [&](std::int32_t node) {
    return node != first && incidence.arcs_at(node).size() == 1;
  };
  const bool has_leaf = std::any_of(paths.reached().begin(), paths.reached().end(), is_leaf);
  last = first;
  for (const std::int32_t node : paths.reached()) {
    if (has_leaf && !is_leaf(node)) continue;
    const std::int64_t distance = paths.distance(node), most = paths.distance(last);
    if (distance > most || (distance == most && node < last)) last = node;
  }
  return paths.path_to(last);
}

}  // namespace vorotool::core
