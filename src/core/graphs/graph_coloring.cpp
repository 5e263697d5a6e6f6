#include "core/graphs/graph_coloring.hpp"

#include <algorithm>

#include "core/base/groups.hpp"

namespace vorotool::core::graphs {

using base::Monitor;

namespace {

using Adjacency = base::Groups<std::uint32_t>;  // neighbors of each vertex

// Vertices sorted by their degree among the vertices not yet taken, in buckets of one array.
class DegreeOrder {
 public:
  explicit DegreeOrder(const Adjacency& graph)
      : order_(graph.size()), place_(graph.size()), degree_(graph.size()) {
    std::size_t largest = 0;
    for (std::size_t v = 0; v < graph.size(); ++v) largest = std::max(largest, graph[v].size());
    bucket_.assign(largest + 2, 0);
    for (std::size_t v = 0; v < graph.size(); ++v) ++bucket_[graph[v].size() + 1];
    for (std::size_t d = 1; d < bucket_.size(); ++d) bucket_[d] += bucket_[d - 1];
    std::vector<std::size_t> next = bucket_;
    for (std::size_t v = 0; v < graph.size(); ++v) {
      degree_[v] = graph[v].size();
      place_[v] = next[degree_[v]]++;
      order_[place_[v]] = static_cast<std::uint32_t>(v);
    }
  }

  // The vertex of smallest degree that is `taken`-th to go; its degree is counted no more.
  std::uint32_t take(std::size_t taken) {
    const std::uint32_t vertex = order_[taken];
    current_ = degree_[vertex];
    bucket_[current_] = taken + 1;
    return vertex;
  }

  // One neighbor less: swaps with the first of its bucket, which then begins one place later. A vertex of
  // the smallest degree stays: it goes next anyway, and so no bucket reaches back among the taken.
  void lower(std::uint32_t vertex) {
    if (degree_[vertex] <= current_) return;
    const std::size_t to = bucket_[degree_[vertex]]++;
    const std::size_t from = place_[vertex];
    std::swap(order_[from], order_[to]);
    place_[order_[from]] = from;
    place_[vertex] = to;
    --degree_[vertex];
  }

  const std::vector<std::uint32_t>& order() const { return order_; }

 private:
  std::vector<std::uint32_t> order_;
  std::vector<std::size_t> place_;   // order_[place_[v]] == v
  std::vector<std::size_t> degree_;  // at least current_ for those not taken
  std::vector<std::size_t> bucket_;  // where the vertices of each degree begin in order_
  std::size_t current_ = 0;
};

// The degeneracy order: every vertex has the smallest degree among itself and those after it.
std::vector<std::uint32_t> smallest_first(const Adjacency& graph, const Monitor& monitor) {
  DegreeOrder order(graph);
  for (std::size_t taken = 0; taken < graph.size(); ++taken) {
    base::report_item(monitor, taken);
    for (const std::uint32_t neighbor : graph[order.take(taken)]) order.lower(neighbor);
  }
  return order.order();
}

// Colors 1, 2, ... and how often each is used.
class Palette {
 public:
  // Forbids a color for the vertex at hand.
  void forbid(std::uint32_t color, std::uint32_t vertex) {
    forbidden_for_[color] = std::uint64_t{vertex} + 1;
  }

  std::uint32_t choose(std::uint32_t vertex) {
    std::size_t best = 0;
    for (std::size_t color = 1; color < uses_.size(); ++color) {
      if (forbidden_for_[color] == std::uint64_t{vertex} + 1) continue;
      if (best == 0 || uses_[color] < uses_[best]) best = color;
    }
    if (best == 0) {
      best = uses_.size();
      uses_.push_back(0);
      forbidden_for_.push_back(0);
    }
    ++uses_[best];
    return static_cast<std::uint32_t>(best);
  }

 private:
  std::vector<std::uint64_t> uses_{0};           // entry 0, "no color yet", is not used
  std::vector<std::uint64_t> forbidden_for_{0};  // the last vertex + 1 that must not take it
};

}  // namespace

std::vector<std::uint32_t> color_graph(std::size_t vertices, std::span<const Edge> edges,
                                       const Monitor& monitor) {
  const Adjacency graph(vertices, [&](const auto& add) {
    for (const Edge& edge : edges) {
      add(edge.a, edge.b);
      add(edge.b, edge.a);
    }
  });
  const std::vector<std::uint32_t> order = smallest_first(graph, monitor);
  std::vector<std::uint32_t> colors(vertices, 0);
  Palette palette;
  for (std::size_t k = vertices; k-- > 0;) {
    base::report_item(monitor, k);
    const std::uint32_t vertex = order[k];
    for (const std::uint32_t neighbor : graph[vertex]) palette.forbid(colors[neighbor], vertex);
    colors[vertex] = palette.choose(vertex);
  }
  return colors;
}

}  // namespace vorotool::core::graphs
