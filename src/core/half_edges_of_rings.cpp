#include "core/half_edges_of_rings.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace vorotool::core {

namespace {

std::span<const Vertex> ring(const RingVertex& vertex) { return {vertex.ring(), vertex.degree()}; }

HalfEdge edges_of(std::span<const RingVertex> vertices) {
  HalfEdge twice = 0;
  for (const RingVertex& vertex : vertices) twice += static_cast<HalfEdge>(vertex.degree());
  return twice / 2;
}

// Goes through the vertices in their order, and makes edges at the earlier one of their ends. Half-edges that
// wait for their later vertex form a list there, which ends with one that is next to itself. No ring is
// searched: one may hold half of all vertices.
class Conversion {
 public:
  explicit Conversion(std::span<const RingVertex> vertices)
      : vertices_(vertices),
        edges_(static_cast<std::size_t>(edges_of(vertices))),
        waiting_(vertices.size(), no_edge),
        towards_(vertices.size()) {}

  HalfEdges run() && {
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      if (vertices_[v].degree() > 0) make_ring(static_cast<Vertex>(v));
    }
    return std::move(edges_);
  }

 private:
  void make_ring(Vertex v) {
    look_up_waiting(v);
    const std::span<const Vertex> neighbours = ring(vertices_[static_cast<std::size_t>(v)]);
    const HalfEdge first = half_edge(v, neighbours[0]);
    HalfEdge last = first;
    for (const Vertex w : neighbours.subspan(1)) {
      const HalfEdge e = half_edge(v, w);
      edges_.link(last, e);
      last = e;
    }
    edges_.link(last, first);
  }

  void look_up_waiting(Vertex v) {
    HalfEdge e = waiting_[static_cast<std::size_t>(v)], last = no_edge;
    for (; e != last && e != no_edge; e = edges_.next_around(e)) {
      towards_[static_cast<std::size_t>(edges_.target(e))] = e;
      last = e;
    }
  }

  HalfEdge half_edge(Vertex v, Vertex w) {
    if (w < v) return towards_[static_cast<std::size_t>(w)];
    const HalfEdge e = 2 * made_++;
    edges_.make(e, v, w);
    HalfEdge& waiting = waiting_[static_cast<std::size_t>(w)];
    if (waiting != no_edge) edges_.link(HalfEdges::twin(e), waiting);
    waiting = HalfEdges::twin(e);
    return e;
  }

  std::span<const RingVertex> vertices_;
  HalfEdges edges_;
  HalfEdge made_ = 0;              // edges
  std::vector<HalfEdge> waiting_;  // [vertices] the first half-edge that waits there
  std::vector<HalfEdge>
      towards_;  // [vertices] of the vertex at work, the half-edge to each earlier neighbour
};

}  // namespace

HalfEdges half_edges_of(std::span<const RingVertex> vertices) { return Conversion(vertices).run(); }

HalfEdge front_edge(std::span<const RingVertex> vertices, const HalfEdges& edges, Vertex v) {
  const RingVertex& vertex = vertices[static_cast<std::size_t>(v)];
  if (vertex.degree() == 0) return no_edge;
  const Vertex w = vertex.front();
  for (HalfEdge e = 0; e < edges.size(); ++e) {
    if (edges.origin(e) == v && edges.target(e) == w) return e;
  }
  return no_edge;
}

}  // namespace vorotool::core
