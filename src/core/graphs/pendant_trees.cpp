#include "core/graphs/pendant_trees.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace vorotool::core::graphs {

using base::at;

namespace {}  // namespace

PendantTrees::PendantTrees(std::span<const base::IndexPair> arcs, std::span<const std::uint8_t> is_anchored)
    : above_(is_anchored.size(), -1), degree_(is_anchored.size()), tree_(is_anchored.size(), -1) {
  for (const auto& [source, target] : arcs) {
    ++degree_[at(source)];
    ++degree_[at(target)];
  }
  peel(arcs, is_anchored);
}

void PendantTrees::peel(std::span<const base::IndexPair> arcs, std::span<const std::uint8_t> is_anchored) {
  std::vector<std::int32_t> left = degree_, others(degree_.size());  // exclusive or of the arcs that are left
  for (std::size_t k = 0; k < arcs.size(); ++k) {
    others[at(arcs[k][0])] ^= static_cast<std::int32_t>(k);
    others[at(arcs[k][1])] ^= static_cast<std::int32_t>(k);
  }
  for (std::size_t k = 0; k < degree_.size(); ++k) {
    auto node = static_cast<std::int32_t>(k);
    while (left[at(node)] == 1 && !is_anchored[at(node)]) {
      const std::int32_t arc = others[at(node)];
      const std::int32_t inner = arcs[at(arc)][0] == node ? arcs[at(arc)][1] : arcs[at(arc)][0];
      hanging_.push_back({arc, node, inner});
      left[at(node)] = 0;
      --left[at(inner)];
      others[at(inner)] ^= arc;
      node = inner;
    }
  }
  for (std::size_t k = 0; k < left.size(); ++k) {
    if (!is_anchored[k]) continue;
    if (left[k] == 0 && degree_[k] > 0) lone_ends_.push_back(static_cast<std::int32_t>(k));
    left[k] = 1;  // no root that could be another
  }
  number_trees(left);
}

// Roots are the inner ends of which nothing is left.
void PendantTrees::number_trees(const std::vector<std::int32_t>& left) {
  for (std::size_t k = hanging_.size(); k-- > 0;) {
    const auto [arc, outer, inner] = hanging_[k];
    above_[at(outer)] = static_cast<std::int32_t>(k);
    if (above_[at(inner)] < 0 && left[at(inner)] == 0 && tree_[at(inner)] < 0) {
      tree_[at(inner)] = static_cast<std::int32_t>(roots_.size());
      roots_.push_back(inner);
    }
    tree_[at(outer)] = tree_[at(inner)];
  }
}

void PendantTrees::number_arcs() {
  for (std::size_t k = 0; k < hanging_.size(); ++k) {
    above_[at(hanging_[k].outer)] = static_cast<std::int32_t>(k);
  }
}

// The arcs between an old root and a new one hang the other way round then, and what hung on them still does.
void PendantTrees::set_roots(std::span<const std::int32_t> roots) {
  std::vector<bool> is_turned(hanging_.size());
  std::vector<std::int32_t> turned;
  for (std::size_t tree = 0; tree < roots.size(); ++tree) {
    std::int32_t node = roots[tree];
    for (std::int32_t k = above(node); k >= 0; k = above(node)) {
      is_turned[at(k)] = true;
      turned.push_back(k);
      node = hanging_[at(k)].inner;
    }
    above_[at(roots[tree])] = -1;
    roots_[tree] = roots[tree];
  }
  std::sort(turned.begin(), turned.end(), std::greater<>());  // those next to the old root come first
  std::vector<HangingArc> order;
  order.reserve(hanging_.size());
  for (std::size_t k = 0; k < hanging_.size(); ++k) {
    if (!is_turned[k]) order.push_back(hanging_[k]);
  }
  for (const std::int32_t k : turned) {
    const auto [arc, outer, inner] = hanging_[at(k)];
    order.push_back({arc, inner, outer});
  }
  hanging_ = std::move(order);
  number_arcs();
}

}  // namespace vorotool::core::graphs
