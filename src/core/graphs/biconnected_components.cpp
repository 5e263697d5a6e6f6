#include "core/graphs/biconnected_components.hpp"

#include <algorithm>
#include <cstddef>

#include "core/base/indices.hpp"

namespace vorotool::core::graphs {

using base::at;

namespace {

using Index = std::int32_t;

class DepthFirst {
 public:
  DepthFirst(std::size_t nodes, std::span<const std::array<Index, 2>> edges)
      : edges_(edges),
        first_(nodes + 1),
        rank_(nodes, -1),
        lowest_(nodes),
        next_(nodes),
        component_(edges.size()) {
    for (const auto& ends : edges) {
      for (const Index node : ends) ++first_[at(node) + 1];
    }
    for (std::size_t v = 0; v < nodes; ++v) first_[v + 1] += first_[v];
    std::copy(first_.begin(), first_.end() - 1, next_.begin());
    incident_.resize(2 * edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
      for (const Index node : edges[e]) incident_[next_[at(node)]++] = static_cast<Index>(e);
    }
    std::copy(first_.begin(), first_.end() - 1, next_.begin());
  }

  std::vector<Index> components() {
    for (std::size_t v = 0; v < rank_.size(); ++v) {
      if (rank_[v] < 0) search(static_cast<Index>(v));
    }
    return std::move(component_);
  }

 private:
  struct Step {
    Index node, edge;  // the edge that leads there, -1: none
  };

  void enter(const Step& step) {
    path_.push_back(step);
    rank_[at(step.node)] = lowest_[at(step.node)] = visited_++;
  }

  void search(Index root) {
    enter({root, -1});
    while (!path_.empty()) {
      const Step step = path_.back();
      if (next_[at(step.node)] < first_[at(step.node) + 1]) {
        follow(step, incident_[next_[at(step.node)]++]);
      } else {
        leave(step);
      }
    }
  }

  void follow(const Step& step, Index edge) {
    const auto& [a, b] = edges_[at(edge)];
    const Index other = a == step.node ? b : a;
    if (edge == step.edge || rank_[at(other)] > rank_[at(step.node)]) return;  // seen from there
    stack_.push_back(edge);
    if (rank_[at(other)] < 0) {
      enter({other, edge});
    } else {
      lowest_[at(step.node)] = std::min(lowest_[at(step.node)], rank_[at(other)]);
    }
  }

  // The edges stacked since the one to a node are a component if no edge below leads above its other end.
  void leave(const Step& step) {
    path_.pop_back();
    if (path_.empty()) return;
    const auto above = at(path_.back().node);
    lowest_[above] = std::min(lowest_[above], lowest_[at(step.node)]);
    if (lowest_[at(step.node)] < rank_[above]) return;
    Index edge;
    do {
      edge = stack_.back();
      stack_.pop_back();
      component_[at(edge)] = count_;
    } while (edge != step.edge);
    ++count_;
  }

  std::span<const std::array<Index, 2>> edges_;
  std::vector<std::size_t> first_;    // [nodes + 1] where the edges of each begin in the following list
  std::vector<Index> incident_;       // [2 edges]
  std::vector<Index> rank_, lowest_;  // [nodes] in the order of visits; the lowest that is reached from below
  std::vector<std::size_t> next_;     // [nodes] the edge to look at
  std::vector<Index> component_;      // [edges]
  std::vector<Step> path_;
  std::vector<Index> stack_;
  Index visited_ = 0, count_ = 0;
};

}  // namespace

std::vector<Index> biconnected_components(std::size_t nodes, std::span<const std::array<Index, 2>> edges) {
  return DepthFirst(nodes, edges).components();
}

}  // namespace vorotool::core::graphs
