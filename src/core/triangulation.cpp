#include "core/triangulation.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

#include "core/cocircular_fans.hpp"
#include "core/divide_and_conquer.hpp"
#include "core/parallel.hpp"
#include "core/point_order.hpp"

namespace vorotool::core {

namespace {

constexpr std::size_t most_points = std::size_t{1} << 28;  // six half-edges a point in 32 bits
constexpr std::size_t vertices_a_piece = std::size_t{1} << 14;

// Half-edges with the unbounded face on their left, and the vertices that they leave, counter-clockwise.
std::vector<bool> walk_hull(const Subdivision& subdivision, std::vector<std::int32_t>& vertices) {
  const HalfEdges& edges = subdivision.edges;
  std::vector<bool> outer(static_cast<std::size_t>(edges.size()), false);
  if (subdivision.hull == no_edge) return outer;
  const HalfEdge start = HalfEdges::twin(subdivision.hull);  // its left face is the unbounded one, gone round clockwise
  HalfEdge e = start;
  do {
    outer[static_cast<std::size_t>(e)] = true;
    vertices.push_back(edges.origin(e));
    e = edges.next_left(e);
  } while (e != start);
  std::reverse(vertices.begin(), vertices.end());
  return outer;
}

// Writes triangles and edges vertex by vertex: each at the vertex that comes first on the curve, in counter-clockwise
// order from the half-edge to the first of its neighbours. That order depends on the points alone.
class Extraction {
 public:
  Extraction(const HalfEdges& edges, const std::vector<bool>& outer, const std::vector<std::uint32_t>& index)
      : edges_(edges), outer_(outer), index_(index), leaving_(index.size(), no_edge),
        triangle_of_(static_cast<std::size_t>(edges.size()), -1) {
    for (HalfEdge e = 0; e < edges.size(); ++e) {
      if (edges.exists(e)) leaving_[static_cast<std::size_t>(edges.origin(e))] = e;
    }
  }

  void run(Triangulation& result, unsigned threads, const Monitor& monitor) {
    const std::size_t pieces = piece_count(index_.size(), vertices_a_piece);
    std::vector<Counts> counts(pieces + 1);
    parallel_for(pieces, threads, [&](std::size_t piece) { counts[piece + 1] = count(piece); }, monitor);
    std::partial_sum(counts.begin(), counts.end(), counts.begin(), [](const Counts& a, const Counts& b) {
      return Counts{a.triangles + b.triangles, a.edges + b.edges};
    });
    result.triangles.resize(3 * counts.back().triangles);
    result.neighbours.resize(3 * counts.back().triangles);
    result.edges.resize(2 * counts.back().edges);
    corner_.resize(counts.back().triangles);
    parallel_for(pieces, threads, [&](std::size_t piece) { write(piece, counts[piece], result); }, monitor);
    const std::size_t blocks = piece_count(corner_.size(), vertices_a_piece);
    parallel_for(blocks, threads, [&](std::size_t block) { link(block, result); }, monitor);
  }

 private:
  struct Counts {
    std::size_t triangles = 0, edges = 0;
  };

  bool outer(HalfEdge e) const { return outer_[static_cast<std::size_t>(e)]; }

  // Calls visit(half-edge, its target, whether the triangle on its left belongs to v) for the half-edges that leave v
  // towards later vertices, from the one with the earliest target on.
  template <class Visit>
  void for_each_at(Vertex v, Visit visit) const {
    HalfEdge start = leaving_[static_cast<std::size_t>(v)];
    if (start == no_edge) return;
    Vertex earliest = edges_.target(start);
    for (HalfEdge e = edges_.next_around(start), end = start; e != end; e = edges_.next_around(e)) {
      if (edges_.target(e) < earliest) {
        earliest = edges_.target(e);
        start = e;
      }
    }
    HalfEdge e = start;
    do {
      const HalfEdge following = edges_.next_around(e);
      const Vertex w = edges_.target(e);
      if (w > v) visit(e, w, !outer(e) && edges_.target(following) > v);
      e = following;
    } while (e != start);
  }

  template <class Body>
  void for_each_vertex(std::size_t piece, Body body) const {
    const std::size_t end = std::min(index_.size(), (piece + 1) * vertices_a_piece);
    for (std::size_t v = piece * vertices_a_piece; v < end; ++v) body(static_cast<Vertex>(v));
  }

  Counts count(std::size_t piece) const {
    Counts found;
    for_each_vertex(piece, [&](Vertex v) {
      for_each_at(v, [&](HalfEdge, Vertex, bool triangle) {
        ++found.edges;
        found.triangles += triangle;
      });
    });
    return found;
  }

  void write(std::size_t piece, Counts next, Triangulation& result) {
    for_each_vertex(piece, [&](Vertex v) {
      for_each_at(v, [&](HalfEdge e, Vertex w, bool triangle) {
        result.edges[2 * next.edges] = given(v);
        result.edges[2 * next.edges + 1] = given(w);
        ++next.edges;
        if (!triangle) return;
        const std::array<HalfEdge, 3> sides{e, edges_.next_left(e), edges_.next_left(edges_.next_left(e))};
        for (std::size_t k = 0; k < 3; ++k) {
          result.triangles[3 * next.triangles + k] = given(edges_.origin(sides[k]));
          triangle_of_[static_cast<std::size_t>(sides[k])] = static_cast<std::int32_t>(next.triangles);
        }
        corner_[next.triangles++] = e;
      });
    });
  }

  void link(std::size_t block, Triangulation& result) const {
    const std::size_t end = std::min(corner_.size(), (block + 1) * vertices_a_piece);
    for (std::size_t t = block * vertices_a_piece; t < end; ++t) {
      HalfEdge e = corner_[t];
      for (const std::size_t opposite : {2U, 0U, 1U}) {  // the first side lies opposite to the last vertex
        result.neighbours[3 * t + opposite] = triangle_of_[static_cast<std::size_t>(HalfEdges::twin(e))];
        e = edges_.next_left(e);
      }
    }
  }

  std::int32_t given(Vertex v) const { return static_cast<std::int32_t>(index_[static_cast<std::size_t>(v)]); }

  const HalfEdges& edges_;
  const std::vector<bool>& outer_;
  const std::vector<std::uint32_t>& index_;
  std::vector<HalfEdge> leaving_;          // [vertices] any half-edge that leaves it
  std::vector<std::int32_t> triangle_of_;  // [half-edges] the triangle on the left, -1 for the unbounded face
  std::vector<HalfEdge> corner_;           // [triangles] the half-edge that leaves its first vertex
};

// A chain's hull is gone along both ways: the way from its first end to the other one is enough.
void keep_one_way(std::vector<std::int32_t>& hull) {
  if (hull.size() > 1) hull.resize(hull.size() / 2 + 1);
}

}  // namespace

Triangulation triangulate(std::span<const Point> points, unsigned threads, const Monitor& monitor) {
  if (points.size() > most_points) throw std::length_error("more than 268435456 points");
  Triangulation result;
  result.first.resize(points.size());
  MortonOrder order = morton_order(points, result.first);
  Subdivision subdivision = divide_and_conquer({order.points, order.index, order.code}, threads, monitor);
  const std::vector<bool> outer = walk_hull(subdivision, result.hull);
  if (subdivision.degenerate) make_fans(subdivision.edges, outer, order.points, threads, monitor);
  Extraction(subdivision.edges, outer, order.index).run(result, threads, monitor);
  if (order.points.size() == 1) result.hull = {0};
  if (result.triangles.empty()) keep_one_way(result.hull);
  for (std::int32_t& v : result.hull) v = static_cast<std::int32_t>(order.index[static_cast<std::size_t>(v)]);
  return result;
}

}  // namespace vorotool::core
