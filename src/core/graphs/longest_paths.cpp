#include "core/graphs/longest_paths.hpp"

#include <algorithm>
#include <utility>

#include "core/graphs/pendant_trees.hpp"
#include "core/graphs/two_core.hpp"

namespace vorotool::core::graphs {

using base::at;
using base::Monitor;

namespace {

class PathFinder {
 public:
  PathFinder(std::span<const base::IndexPair> arcs, std::span<const std::int64_t> lengths,
             std::span<const std::int32_t> group, std::size_t groups, std::size_t nodes, double tie,
             const Monitor& monitor)
      : arcs_(arcs),
        lengths_(lengths),
        tie_(tie),
        monitor_(monitor),
        forest_(arcs, std::vector<std::uint8_t>(nodes)),
        deepest_(nodes),
        second_(nodes),
        group_(nodes),
        mark_(nodes, -1),
        best_(groups),
        core_(arcs_at_nodes(arcs, nodes, is_in_core())),
        paths_(arcs, lengths, core_, nodes) {
    for (std::size_t k = 0; k < arcs.size(); ++k) group_[at(arcs[k][0])] = group_[at(arcs[k][1])] = group[k];
  }

  std::vector<GraphPath> find() {
    base::report(monitor_, 0);
    pairs_in_trees();
    if (forest_.hanging().size() < arcs_.size()) {
      for (const LeafPair& pair : farthest_pairs(arcs_, lengths_, core_, deepest_, monitor_)) consider(pair);
    }
    if (tie_ > 0) settle_ties();
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

  // In trees, among the pairs nearly as far apart as the best, that with the smallest numbers. What is
  // farthest from any node of a tree is one of the best pair.
  void settle_ties() {
    std::vector<std::size_t> groups;
    std::vector<std::int64_t> least(best_.size());
    for (std::size_t k = 0; k < best_.size(); ++k) {
      const LeafPair& best = best_[k];
      if (best.first < 0 || forest_.tree(best.first) < 0 || best.first_node != best.last_node) continue;
      groups.push_back(k);
      least[k] = best.length - static_cast<std::int64_t>(tie_ * static_cast<double>(best.length));
    }
    const std::vector<std::int64_t> to_first = distances(groups, &LeafPair::first);
    const std::vector<std::int64_t> to_last = distances(groups, &LeafPair::last);
    set_smallest(groups, &LeafPair::first, [&](std::size_t node, std::size_t k) {
      return std::max(to_first[node], to_last[node]) >= least[k];
    });
    const std::vector<std::int64_t> from_first = distances(groups, &LeafPair::first);
    set_smallest(groups, &LeafPair::last, [&](std::size_t node, std::size_t k) {
      return from_first[node] >= least[k] && static_cast<std::int32_t>(node) != best_[k].first;
    });
    for (const std::size_t k : groups) best_[k].first_node = best_[k].last_node = turn_of(best_[k]);
  }

  // From an end of the best pair of each of some groups to the nodes of its tree; -1 for others.
  std::vector<std::int64_t> distances(std::span<const std::size_t> groups,
                                      std::int32_t LeafPair::* end) const {
    std::vector<std::int64_t> found(deepest_.size(), -1);
    const std::vector<HangingArc>& hanging = forest_.hanging();
    for (const std::size_t k : groups) {
      std::int32_t node = best_[k].*end;
      found[at(node)] = 0;
      while (forest_.above(node) >= 0) {
        const HangingArc& arc = hanging[at(forest_.above(node))];
        found[at(arc.inner)] = found[at(node)] + lengths_[at(arc.arc)];
        node = arc.inner;
      }
    }
    for (std::size_t k = hanging.size(); k-- > 0;) {  // inner ends come before outer ones
      const auto& [arc, outer, inner] = hanging[k];
      if (found[at(outer)] < 0 && found[at(inner)] >= 0)
        found[at(outer)] = found[at(inner)] + lengths_[at(arc)];
    }
    return found;
  }

  // An end of each best pair becomes the smallest leaf that will do.
  template <typename WillDo>
  void set_smallest(std::span<const std::size_t> groups, std::int32_t LeafPair::* end,
                    const WillDo& will_do) {
    std::vector<bool> is_open(best_.size());
    for (const std::size_t k : groups) is_open[k] = true;
    for (std::size_t node = 0; node < deepest_.size(); ++node) {
      const std::size_t k = at(group_[node]);
      if (!is_open[k] || forest_.degree(static_cast<std::int32_t>(node)) != 1 || !will_do(node, k)) continue;
      best_[k].*end = static_cast<std::int32_t>(node);
      is_open[k] = false;
    }
  }

  // Where the path between both leaves of a tree is nearest to its root.
  std::int32_t turn_of(const LeafPair& pair) {
    const std::int32_t mark = pair.first;
    for (std::int32_t node = pair.first;; node = forest_.hanging()[at(forest_.above(node))].inner) {
      mark_[at(node)] = mark;
      if (forest_.above(node) < 0) break;
    }
    std::int32_t node = pair.last;
    while (mark_[at(node)] != mark) node = forest_.hanging()[at(forest_.above(node))].inner;
    return node;
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

  // From a leaf to a node of the tree that holds it.
  GraphPath climb(std::int32_t leaf, std::int32_t node) const {
    GraphPath path{{leaf}, {}};
    while (path.nodes.back() != node) {
      const HangingArc& hanging = forest_.hanging()[at(forest_.above(path.nodes.back()))];
      path.arcs.push_back(hanging.arc);
      path.nodes.push_back(hanging.inner);
    }
    return path;
  }

  // The arcs that begin where the path ends.
  static void append(GraphPath& path, const GraphPath& more) {
    path.nodes.insert(path.nodes.end(), more.nodes.begin() + 1, more.nodes.end());
    path.arcs.insert(path.arcs.end(), more.arcs.begin(), more.arcs.end());
  }

  std::span<const base::IndexPair> arcs_;
  std::span<const std::int64_t> lengths_;
  double tie_;
  const Monitor& monitor_;
  PendantTrees forest_;
  std::vector<Hanging> deepest_, second_;  // at each node
  std::vector<std::int32_t> group_;        // of each node
  std::vector<std::int32_t> mark_;         // the first leaf of a path from there to the root
  std::vector<LeafPair> best_;             // of each group
  GraphIncidence core_;
  ShortestPaths paths_;
};

}  // namespace

std::vector<GraphPath> longest_paths(std::span<const base::IndexPair> arcs,
                                     std::span<const std::int64_t> lengths,
                                     std::span<const std::int32_t> group, std::size_t groups,
                                     std::size_t nodes, double tie, const Monitor& monitor) {
  return PathFinder(arcs, lengths, group, groups, nodes, tie, monitor).find();
}

GraphPath path_from(std::span<const base::IndexPair> arcs, std::span<const std::int64_t> lengths,
                    std::size_t nodes, std::int32_t first, std::int32_t last, const Monitor& monitor) {
  const GraphIncidence incidence = arcs_at_nodes(arcs, nodes);
  ShortestPaths paths(arcs, lengths, incidence, nodes);
  const ShortestPaths::Start start{first, 0};
  paths.find(std::span(&start, 1), monitor);
  if (last >= 0) return paths.path_to(last);
  const auto is_leaf = [&](std::int32_t node) { return node != first && incidence[node].size() == 1; };
  const bool has_leaf = std::any_of(paths.reached().begin(), paths.reached().end(), is_leaf);
  last = first;
  for (const std::int32_t node : paths.reached()) {
    if (has_leaf && !is_leaf(node)) continue;
    const std::int64_t distance = paths.distance(node), most = paths.distance(last);
    if (distance > most || (distance == most && node < last)) last = node;
  }
  return paths.path_to(last);
}

}  // namespace vorotool::core::graphs
