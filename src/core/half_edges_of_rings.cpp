#include "core/half_edges_of_rings.hpp"

#include <cstddef>
#include <vector>

namespace vorotool::core {

namespace {

std::span<const Vertex> ring(const RingVertex& vertex) { return {vertex.ring(), vertex.degree()}; }

// Counts the edges that are numbered at a vertex before its ring comes to another one.
HalfEdge edges_before(std::span<const RingVertex> vertices, Vertex v, Vertex end) {
  HalfEdge count = 0;
  for (const Vertex w : ring(vertices[static_cast<std::size_t>(v)])) {
    if (w == end) break;
    count += w > v;
  }
  return count;
}

}  // namespace

HalfEdges half_edges_of(std::span<const RingVertex> vertices) {
  std::vector<HalfEdge> first(vertices.size());  // [vertices] the first edge numbered there
  HalfEdge count = 0;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    first[v] = count;
    count += edges_before(vertices, static_cast<Vertex>(v), -1);
  }
  const auto number = [&](Vertex v, Vertex w) {
    const Vertex earlier = v < w ? v : w;
    const HalfEdge edge =
        first[static_cast<std::size_t>(earlier)] + edges_before(vertices, earlier, v < w ? w : v);
    return 2 * edge + (v < w ? 0 : 1);
  };
  HalfEdges edges(static_cast<std::size_t>(count));
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const auto from = static_cast<Vertex>(v);
    for (const Vertex w : ring(vertices[v])) {
      if (w > from) edges.make(number(from, w), from, w);
    }
  }
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const auto from = static_cast<Vertex>(v);
    HalfEdge last = no_edge;
    for (const Vertex w : ring(vertices[v])) {
      const HalfEdge e = number(from, w);
      if (last != no_edge) edges.splice(last, e);
      last = e;
    }
  }
  return edges;
}

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
