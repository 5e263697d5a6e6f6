#include "core/skeleton/branches.hpp"

#include <algorithm>
#include <cstddef>

#include "core/base/groups.hpp"
#include "core/base/indices.hpp"

namespace vorotool::core::skeleton {

using base::at;

namespace {

// Numbers of the arcs of each group.
base::Groups<std::int32_t> by_group(std::span<const GraphArc> arcs) {
  std::int32_t most = -1;
  for (const GraphArc& arc : arcs) most = std::max(most, arc.group);
  return {at(most + 1), [&](const auto& add) {
            for (std::size_t k = 0; k < arcs.size(); ++k) add(arcs[k].group, static_cast<std::int32_t>(k));
          }};
}

class BranchWalk {
 public:
  BranchWalk(std::span<const GraphArc> arcs, std::size_t nodes)
      : arcs_(arcs), nodes_(nodes), is_done_(arcs.size()) {
    for (std::size_t k = 0; k < arcs_.size(); ++k) {
      for (const std::int32_t node : {arcs_[k].source, arcs_[k].target}) {
        ++nodes_[at(node)].degree;
        nodes_[at(node)].others ^= static_cast<std::int32_t>(k);
      }
    }
    order_.arcs.reserve(arcs_.size());
  }

  // Branches of a group.
  void walk_all(std::span<const std::int32_t> group) {
    for (const std::int32_t arc : group) {
      if (is_done_[at(arc)]) continue;
      if (is_inner(arcs_[at(arc)].source)) {
        if (!is_inner(arcs_[at(arc)].target)) walk(arc, true);
      } else {
        walk(arc, false);
      }
    }
    for (const std::int32_t arc : group) {
      if (!is_done_[at(arc)] && !has_end(arc)) walk(arc, false);
    }
  }

  SkeletonOrder take() { return std::move(order_); }

 private:
  struct Node {
    std::int32_t degree = 0;
    std::int32_t others = 0;  // exclusive or of the arcs that end here: less one of two it is the other
    std::int32_t number = -1;
  };

  bool is_inner(std::int32_t node) const { return nodes_[at(node)].degree == 2; }
  bool has_end(std::int32_t arc) const {
    return !is_inner(arcs_[at(arc)].source) || !is_inner(arcs_[at(arc)].target);
  }

  void walk(std::int32_t arc, bool is_reversed) {
    const std::int32_t branch = branches_++;
    while (true) {
      const GraphArc& a = arcs_[at(arc)];
      const std::int32_t from = is_reversed ? a.target : a.source, to = is_reversed ? a.source : a.target;
      is_done_[at(arc)] = true;
      const std::int32_t source = numbered(from);
      order_.arcs.push_back({arc, source, numbered(to), branch, is_reversed});
      if (!is_inner(to)) return;
      arc ^= nodes_[at(to)].others;
      if (is_done_[at(arc)]) return;
      is_reversed = arcs_[at(arc)].source != to;
    }
  }

  std::int32_t numbered(std::int32_t node) {
    std::int32_t& number = nodes_[at(node)].number;
    if (number < 0) {
      number = static_cast<std::int32_t>(order_.nodes.size());
      order_.nodes.push_back(node);
    }
    return number;
  }

  std::span<const GraphArc> arcs_;
  std::vector<Node> nodes_;
  std::vector<bool> is_done_;
  std::int32_t branches_ = 0;
  SkeletonOrder order_;
};

}  // namespace

SkeletonOrder order_by_branches(std::span<const GraphArc> arcs, std::size_t nodes,
                                const base::Monitor& monitor) {
  const base::Groups<std::int32_t> groups = by_group(arcs);
  BranchWalk walk(arcs, nodes);
  for (std::size_t group = 0; group < groups.size(); ++group) {
    walk.walk_all(groups[group]);
    base::report(monitor, static_cast<double>(group + 1) / static_cast<double>(groups.size()));
  }
  return walk.take();
}

}  // namespace vorotool::core::skeleton
