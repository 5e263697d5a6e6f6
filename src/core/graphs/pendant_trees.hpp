// The trees of a skeleton: what its leaves lead to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/indices.hpp"

namespace vorotool::core::graphs {

// An arc that is a leaf once what hangs on its outer end is gone.
struct HangingArc {
  std::int32_t arc;
  std::int32_t outer, inner;  // its nodes
};

// Leaves are peeled from a graph until none is left. What stays of a component is its core: its cycles, what
// leads from one to another, and from there to anchored ends, or between these. Where there is neither a
// cycle nor an anchored end, the component is a tree, and one node stays, its root, which can be chosen.
// Where there is one anchored end and no cycle, this end is all that stays.
class PendantTrees {
 public:
  PendantTrees(std::span<const base::IndexPair> arcs, std::span<const std::uint8_t> is_anchored);

  // Each after all that hang on its outer end.
  const std::vector<HangingArc>& hanging() const { return hanging_; }

  // The place in `hanging` of the arc by which a node hangs; -1 for roots and nodes of a core.
  std::int32_t above(std::int32_t node) const { return above_[static_cast<std::size_t>(node)]; }

  std::int32_t degree(std::int32_t node) const { return degree_[static_cast<std::size_t>(node)]; }

  // Components that are trees are numbered; -1 for what hangs on a core, and for the core.
  std::size_t tree_count() const { return roots_.size(); }
  std::int32_t tree(std::int32_t node) const { return tree_[static_cast<std::size_t>(node)]; }

  // Anchored ends that are all that stays of a component.
  const std::vector<std::int32_t>& lone_ends() const { return lone_ends_; }

  // Makes a node of each tree its root.
  void set_roots(std::span<const std::int32_t> roots);

 private:
  void peel(std::span<const base::IndexPair> arcs, std::span<const std::uint8_t> is_anchored);
  void number_trees(const std::vector<std::int32_t>& left);
  void number_arcs();

  std::vector<HangingArc> hanging_;
  std::vector<std::int32_t> above_, degree_, tree_, roots_, lone_ends_;
};

}  // namespace vorotool::core::graphs
