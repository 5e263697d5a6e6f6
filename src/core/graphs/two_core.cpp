#include "core/graphs/two_core.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace vorotool::core::graphs {

using base::at;
using base::Monitor;

namespace {

struct Terminal {
  std::int32_t node;
  Hanging hanging;
  std::int64_t offset = 0;  // from the first junction of its chain
};

struct Chain {
  std::int32_t first, last;  // junctions
  std::int64_t length;
  std::size_t begin, end;  // of its terminals, without those at the junctions
};

// A component: its junctions, with a node of a mere cycle as one, and the chains between them.
struct Component {
  std::vector<Terminal> junctions;  // leaf -1 where nothing hangs
  std::vector<Chain> chains;
  std::vector<Terminal> terminals;
  std::int32_t lone = -1;  // the node at which the only leaf hangs
};

class ComponentWalk {
 public:
  ComponentWalk(std::span<const base::IndexPair> arcs, std::span<const std::int64_t> lengths,
                const GraphIncidence& core, std::span<const Hanging> hanging)
      : arcs_(arcs),
        lengths_(lengths),
        core_(core),
        hanging_(hanging),
        is_seen_(hanging.size()),
        is_walked_(arcs.size()),
        junction_(hanging.size(), -1) {}

  // The component of a node; empty if it was seen before, or is not of the core.
  Component component(std::int32_t node) {
    Component found;
    if (is_seen_[at(node)] || core_[node].empty()) return found;
    const std::vector<std::int32_t> nodes = connected(node);
    std::int32_t leaves = 0;
    for (const std::int32_t n : nodes) {
      leaves += hanging_[at(n)].leaves;
      if (hanging_[at(n)].leaves > 0) found.lone = n;
    }
    if (leaves != 1) found.lone = -1;
    has_leaves_ = leaves > 0;
    for (const std::int32_t n : nodes) {
      if (core_[n].size() > 2) add_junction(found, n);
    }
    if (found.junctions.empty()) add_junction(found, node);
    for (std::size_t k = 0; k < found.junctions.size(); ++k) {
      for (const std::int32_t arc : core_[found.junctions[k].node]) {
        if (!is_walked_[at(arc)]) walk(found, static_cast<std::int32_t>(k), arc);
      }
    }
    return found;
  }

 private:
  std::vector<std::int32_t> connected(std::int32_t node) {
    std::vector<std::int32_t> nodes{node};
    is_seen_[at(node)] = true;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      for (const std::int32_t arc : core_[nodes[k]]) {
        const std::int32_t other = other_end(arc, nodes[k]);
        if (!is_seen_[at(other)]) nodes.push_back(other);
        is_seen_[at(other)] = true;
      }
    }
    return nodes;
  }

  void add_junction(Component& component, std::int32_t node) {
    junction_[at(node)] = static_cast<std::int32_t>(component.junctions.size());
    component.junctions.push_back({node, hanging_at(node)});
  }

  void walk(Component& component, std::int32_t first, std::int32_t arc) {
    const std::size_t begin = component.terminals.size();
    std::int32_t node = component.junctions[at(first)].node;
    std::int64_t offset = 0;
    while (true) {
      is_walked_[at(arc)] = true;
      offset += lengths_[at(arc)];
      node = other_end(arc, node);
      if (junction_[at(node)] >= 0) break;
      const Hanging hanging = hanging_at(node);
      if (hanging.leaf >= 0) component.terminals.push_back({node, hanging, offset});
      const auto both = core_[node];
      arc = both[0] == arc ? both[1] : both[0];
    }
    component.chains.push_back({first, junction_[at(node)], offset, begin, component.terminals.size()});
  }

  Hanging hanging_at(std::int32_t node) const {
    return has_leaves_ ? hanging_[at(node)] : Hanging{0, node, 1};
  }
  std::int32_t other_end(std::int32_t arc, std::int32_t node) const {
    const auto [a, b] = arcs_[at(arc)];
    return a == node ? b : a;
  }

  std::span<const base::IndexPair> arcs_;
  std::span<const std::int64_t> lengths_;
  const GraphIncidence& core_;
  std::span<const Hanging> hanging_;
  std::vector<bool> is_seen_, is_walked_;
  std::vector<std::int32_t> junction_;  // by node
  bool has_leaves_ = false;
};

// Terminals of a component that are farthest from each other, with what hangs at both.
//
// From a source, with the distances of the junctions, a terminal at offset y of a chain of length l is
// min(a + y, b + l - y) away: up to some y the first counts, from there on the second, so that the best of
// each comes from the best among the first terminals, or the last.
class FarthestPair {
 public:
  FarthestPair(const Component& component, const Monitor& monitor)
      : component_(component),
        monitor_(monitor),
        ends_(ends_of(component)),
        lengths_(lengths_of(component)),
        incidence_(arcs_at_nodes(ends_, component.junctions.size())),
        paths_(ends_, lengths_, incidence_, component.junctions.size()),
        best_before_(component.terminals.size()),
        best_after_(component.terminals.size()),
        bound_(component.junctions.size(), std::numeric_limits<std::int64_t>::max()) {
    for (const Chain& chain : component.chains) {
      for (std::size_t k = chain.begin; k < chain.end; ++k) {
        best_before_[k] = k == chain.begin || is_better(k, best_before_[k - 1], 1) ? k : best_before_[k - 1];
      }
      for (std::size_t k = chain.end; k-- > chain.begin;) {
        best_after_[k] = k + 1 == chain.end || is_better(k, best_after_[k + 1], -1) ? k : best_after_[k + 1];
      }
    }
  }

  LeafPair find() {
    search_ends_and_middle();
    std::vector<std::size_t> order(component_.junctions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return bound_[a] > bound_[b]; });
    for (const std::size_t k : order) {
      const Hanging& hanging = component_.junctions[k].hanging;
      if (hanging.leaf >= 0 && hanging.depth + bound_[k] >= best_.length) from_junction(k);
    }
    for (const Chain& chain : component_.chains) from_chain(chain);
    return best_;
  }

 private:
  static std::vector<base::IndexPair> ends_of(const Component& component) {
    std::vector<base::IndexPair> ends;
    for (const Chain& chain : component.chains) ends.push_back({chain.first, chain.last});
    return ends;
  }
  static std::vector<std::int64_t> lengths_of(const Component& component) {
    std::vector<std::int64_t> lengths;
    for (const Chain& chain : component.chains) lengths.push_back(chain.length);
    return lengths;
  }

  const Terminal& terminal(std::size_t k) const { return component_.terminals[k]; }

  // Whether terminal k is to be preferred, where the way to terminals grows with the offset, or shrinks.
  bool is_better(std::size_t k, std::size_t other, std::int64_t direction) const {
    const Terminal &a = terminal(k), &b = terminal(other);
    const std::int64_t first = direction * a.offset + a.hanging.depth;
    const std::int64_t second = direction * b.offset + b.hanging.depth;
    return first != second ? first > second : a.hanging.leaf < b.hanging.leaf;
  }

  // The distances of the junctions from one; a path from any of them goes no farther than over that one.
  std::vector<std::int64_t> from_junction(std::size_t k) {
    const ShortestPaths::Start start{static_cast<std::int32_t>(k), 0};
    source_ = component_.junctions[k];
    search(std::span(&start, 1), nullptr);
    const std::int64_t reach = std::max(farthest_, source_.hanging.depth);
    std::vector<std::int64_t> distance(bound_.size());
    for (std::size_t j = 0; j < bound_.size(); ++j) {
      distance[j] = paths_.distance(static_cast<std::int32_t>(j));
      bound_[j] = std::min(bound_[j], distance[j] + reach);
    }
    return distance;
  }

  // Two ends far from each other give a long path to begin with, and a junction between them good bounds
  // (Magnien, Latapy and Habib 2009).
  void search_ends_and_middle() {
    const auto farthest = [](const std::vector<std::int64_t>& distance) {
      return static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin());
    };
    std::vector<std::int64_t> from_one = from_junction(farthest(from_junction(0)));
    const std::vector<std::int64_t> from_other = from_junction(farthest(from_one));
    for (std::size_t j = 0; j < from_one.size(); ++j) from_one[j] = -std::max(from_one[j], from_other[j]);
    from_junction(farthest(from_one));
  }

  // All but the terminals of the source's own chain.
  void search(std::span<const ShortestPaths::Start> starts, const Chain* own) {
    base::report(monitor_, 0);
    paths_.find(starts, monitor_);
    farthest_ = 0;
    to_junctions();
    for (const Chain& chain : component_.chains) {
      if (&chain != own) to_chain(chain);
    }
  }

  // From one source of a chain to the next what is farthest gets farther by their distance at most: sources
  // that cannot be better than the best are left out.
  void from_chain(const Chain& chain) {
    std::vector<std::size_t> ahead;  // terminals in reach along the chain, each better than all after it
    std::size_t next = chain.begin, front = 0;
    std::int64_t offset = 0, bound = -1;
    for (std::size_t k = chain.begin; k < chain.end; ++k) {
      source_ = terminal(k);
      const std::int64_t over_ends = std::min(source_.offset + bound_[at(chain.first)],
                                              chain.length - source_.offset + bound_[at(chain.last)]);
      const std::int64_t most = std::min(over_ends, bound < 0 ? over_ends : source_.offset - offset + bound);
      if (source_.hanging.depth + most < best_.length) continue;
      const std::array<ShortestPaths::Start, 2> starts{
          {{chain.first, source_.offset}, {chain.last, chain.length - source_.offset}}};
      search(starts, &chain);
      const std::int64_t around = paths_.distance(chain.last) + chain.length;
      std::size_t far = std::max(next, k + 1);
      while (far < chain.end && 2 * terminal(far).offset <= source_.offset + around) ++far;
      for (next = std::max(next, k + 1); next < far; ++next) {
        while (ahead.size() > front && is_better(next, ahead.back(), 1)) ahead.pop_back();
        ahead.push_back(next);
      }
      while (front < ahead.size() && ahead[front] <= k) ++front;
      if (front < ahead.size()) consider(ahead[front], terminal(ahead[front]).offset - source_.offset);
      if (far < chain.end) consider(best_after_[far], around - terminal(best_after_[far]).offset);
      offset = source_.offset;
      bound = farthest_;
    }
  }

  void to_junctions() {
    for (std::size_t k = 0; k < component_.junctions.size(); ++k) {
      const Terminal& junction = component_.junctions[k];
      if (junction.hanging.leaf >= 0 && junction.node != source_.node) {
        consider(junction, paths_.distance(static_cast<std::int32_t>(k)));
      }
    }
  }

  void to_chain(const Chain& chain) {
    const std::int64_t a = paths_.distance(chain.first), b = paths_.distance(chain.last) + chain.length;
    const auto begin = component_.terminals.begin() + static_cast<std::ptrdiff_t>(chain.begin);
    const auto end = component_.terminals.begin() + static_cast<std::ptrdiff_t>(chain.end);
    const auto split =
        std::partition_point(begin, end, [&](const Terminal& t) { return 2 * t.offset <= b - a; });
    const auto k = static_cast<std::size_t>(split - component_.terminals.begin());
    if (k > chain.begin) consider(best_before_[k - 1], a + terminal(best_before_[k - 1]).offset);
    if (k < chain.end) consider(best_after_[k], b - terminal(best_after_[k]).offset);
  }

  void consider(std::size_t k, std::int64_t distance) { consider(terminal(k), distance); }
  void consider(const Terminal& other, std::int64_t distance) {
    farthest_ = std::max(farthest_, distance + other.hanging.depth);
    if (source_.hanging.leaf < 0) return;
    const LeafPair pair = leaf_pair(source_.hanging, source_.node, other.hanging, other.node, distance);
    if (pair.is_better_than(best_)) best_ = pair;
  }

  const Component& component_;
  const Monitor& monitor_;
  std::vector<base::IndexPair> ends_;
  std::vector<std::int64_t> lengths_;
  GraphIncidence incidence_;
  ShortestPaths paths_;                                // between junctions
  std::vector<std::size_t> best_before_, best_after_;  // in each chain
  std::vector<std::int64_t> bound_;  // for each junction: how far the farthest leaf is at most
  Terminal source_{};
  std::int64_t farthest_ = 0;  // from the source
  LeafPair best_;
};

LeafPair with_farthest_node(ShortestPaths& paths, std::int32_t node, const Hanging& hanging,
                            const Monitor& monitor) {
  const ShortestPaths::Start start{node, 0};
  paths.find(std::span(&start, 1), monitor);
  LeafPair best;
  for (const std::int32_t other : paths.reached()) {
    if (other == node) continue;
    const LeafPair pair = leaf_pair(hanging, node, {0, other, 1}, other, paths.distance(other));
    if (pair.is_better_than(best)) best = pair;
  }
  return best;
}

}  // namespace

bool LeafPair::is_better_than(const LeafPair& other) const {
  return length != other.length ? length > other.length
                                : std::tie(first, last) < std::tie(other.first, other.last);
}

LeafPair leaf_pair(const Hanging& a, std::int32_t a_node, const Hanging& b, std::int32_t b_node,
                   std::int64_t between) {
  const std::int64_t length = a.depth + between + b.depth;
  if (a.leaf < b.leaf) return {length, a.leaf, b.leaf, a_node, b_node};
  return {length, b.leaf, a.leaf, b_node, a_node};
}

std::vector<LeafPair> farthest_pairs(std::span<const base::IndexPair> arcs,
                                     std::span<const std::int64_t> lengths, const GraphIncidence& core,
                                     std::span<const Hanging> hanging, const Monitor& monitor) {
  std::vector<LeafPair> pairs;
  ComponentWalk walk(arcs, lengths, core, hanging);
  ShortestPaths paths(arcs, lengths, core, hanging.size());
  for (std::size_t node = 0; node < hanging.size(); ++node) {
    const Component component = walk.component(static_cast<std::int32_t>(node));
    if (component.junctions.empty()) continue;
    const LeafPair pair =
        component.lone >= 0 ? with_farthest_node(paths, component.lone, hanging[at(component.lone)], monitor)
                            : FarthestPair(component, monitor).find();
    if (pair.first >= 0) pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace vorotool::core::graphs
