#include "core/graphs/biconnected_components.hpp"

#include <algorithm>
#include <cstddef>

#include "core/graphs/shortest_paths.hpp"

namespace vorotool::core::graphs {

using base::at;

namespace {

using Index = std::int32_t;

class DepthFirst {
 public:
  DepthFirst(std::size_t nodes, std::span<const std::array<Index, 2>> edges)
      : edges_(edges),
        incident_(arcs_at_nodes(edges, nodes)),
        rank_(nodes, -1),
        lowest_(nodes),
        next_(nodes),
        component_(edges.size()) {}

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
      if (next_[at(step.node)] < incident_[step.node].size()) {
        follow(step, incident_[step.node][next_[at(step.node)]++]);
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
  GraphIncidence incident_;
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
