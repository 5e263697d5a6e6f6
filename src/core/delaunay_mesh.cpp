#include "core/delaunay_mesh.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "core/cocircular_fans.hpp"
#include "core/parallel.hpp"

namespace vorotool::core {

namespace {

constexpr std::size_t most_points = std::size_t{1} << 28;  // six half-edges a point are counted in 32 bits
constexpr int piece_bits = 14;  // vertices of a piece of output, some 0.5 ms of work
constexpr std::size_t piece_size = std::size_t{1} << piece_bits;

}  // namespace

DelaunayMesh::DelaunayMesh(std::span<const Point> points, unsigned threads, const Monitor& monitor)
    : first_(points.size()) {
  if (points.size() > most_points) throw std::length_error("more than 268435456 points");
  order_ = morton_order(points, first_);
  mesh_ = divide_and_conquer({order_.points, order_.index, order_.code}, threads, monitor);
  order_.code = {};
  walk_hull();
  if (mesh_.degenerate) make_fans(mesh_.edges, outer_, order_.points, threads, monitor);
  choose_starts();
}

void DelaunayMesh::walk_hull() {
  const HalfEdges& edges = mesh_.edges;
  outer_.assign(static_cast<std::size_t>(edges.size()), false);
  if (order_.points.size() == 1) hull_ = {given(0)};
  if (mesh_.hull == no_edge) return;
  const HalfEdge start =
      HalfEdges::twin(mesh_.hull);  // the unbounded face is on its left, gone round clockwise
  HalfEdge e = start;
  do {
    outer_[static_cast<std::size_t>(e)] = true;
    hull_.push_back(given(edges.origin(e)));
    e = edges.next_left(e);
  } while (e != start);
  // The walk began at the vertex after the first one.
  std::reverse(hull_.begin(), hull_.end());
  std::rotate(hull_.begin(), hull_.end() - 2, hull_.end());
  // A chain is gone along both ways, from one end; one way is enough.
  const bool chain = hull_.size() == 2 * (order_.points.size() - 1);
  if (chain) hull_.resize(order_.points.size());
}

// Triangles and edges are written vertex by vertex, each at the vertex that comes first on the curve, in
// counter-clockwise order from the half-edge to the earliest neighbour: an order that depends on the points
// alone.
void DelaunayMesh::choose_starts() {
  const HalfEdges& edges = mesh_.edges;
  const std::size_t vertices = order_.points.size();
  start_.assign(vertices, no_edge);
  std::vector<Vertex> earliest(vertices);
  before_.assign(piece_count(vertices, piece_size) + 1, {});
  for (HalfEdge e = 0; e < edges.size(); ++e) {
    if (!edges.exists(e)) continue;
    const Vertex v = edges.origin(e);
    const Vertex w = edges.target(e);
    const auto place = static_cast<std::size_t>(v);
    if (start_[place] == no_edge || w < earliest[place]) {
      start_[place] = e;
      earliest[place] = w;
    }
    if (w < v) continue;
    Counts& counts = before_[(place >> piece_bits) + 1];
    ++counts.edges;
    counts.triangles += !is_outer(e) && edges.target(edges.next_around(e)) > v;
  }
  for (std::size_t i = 1; i < before_.size(); ++i) {
    before_[i].edges += before_[i - 1].edges;
    before_[i].triangles += before_[i - 1].triangles;
  }
  edge_count_ = before_.back().edges;
}

// Calls visit(half-edge, whether the triangle on its left is written here) for the half-edges that leave the
// vertices of a piece towards later ones.
template <class Visit>
void DelaunayMesh::visit_piece(std::size_t piece, Visit visit) const {
  const HalfEdges& edges = mesh_.edges;
  const std::size_t end = std::min(start_.size(), (piece + 1) << piece_bits);
  for (std::size_t place = piece << piece_bits; place < end; ++place) {
    const HalfEdge start = start_[place];
    if (start == no_edge) return;  // the only vertex
    const auto v = static_cast<Vertex>(place);
    HalfEdge e = start;
    Vertex w = edges.target(e);
    do {
      const HalfEdge following = edges.next_around(e);
      const Vertex u = edges.target(following);
      if (w > v) visit(e, u > v && !is_outer(e));
      e = following;
      w = u;
    } while (e != start);
  }
}

void DelaunayMesh::write_edges(std::int32_t* out, unsigned threads, const Monitor& monitor) const {
  const HalfEdges& edges = mesh_.edges;
  parallel_for(
      before_.size() - 1, threads,
      [&](std::size_t piece) {
        std::int32_t* next = out + 2 * before_[piece].edges;
        visit_piece(piece, [&](HalfEdge e, bool) {
          const auto [smaller, larger] = std::minmax({given(edges.origin(e)), given(edges.target(e))});
          *next++ = smaller;
          *next++ = larger;
        });
      },
      monitor);
}

void DelaunayMesh::write_triangles(std::int32_t* triangles, std::int32_t* neighbours, unsigned threads,
                                   const Monitor& monitor) const {
  const HalfEdges& edges = mesh_.edges;
  const bool link = neighbours != nullptr;
  std::vector<HalfEdge> corners(link ? triangle_count()
                                     : 0);  // the half-edge that leaves a triangle's first vertex
  const auto triangle_of = std::make_unique_for_overwrite<std::int32_t[]>(link ? edges.size() : 0);
  parallel_for(
      before_.size() - 1, threads,
      [&](std::size_t piece) {
        std::size_t t = before_[piece].triangles;
        visit_piece(piece, [&](HalfEdge e, bool triangle) {
          if (!triangle) return;
          if (link) corners[t] = e;
          for (int k = 0; k < 3; ++k, e = edges.next_left(e)) {
            triangles[3 * t + static_cast<std::size_t>(k)] = given(edges.origin(e));
            if (link) triangle_of[static_cast<std::size_t>(e)] = static_cast<std::int32_t>(t);
          }
          ++t;
        });
      },
      monitor);
  if (link) link_triangles(corners, triangle_of.get(), neighbours, threads, monitor);
}

void DelaunayMesh::link_triangles(const std::vector<HalfEdge>& corners, const std::int32_t* triangle_of,
                                  std::int32_t* neighbours, unsigned threads, const Monitor& monitor) const {
  parallel_for(
      piece_count(corners.size(), piece_size), threads,
      [&](std::size_t piece) {
        const std::size_t end = std::min(corners.size(), (piece + 1) << piece_bits);
        for (std::size_t t = piece << piece_bits; t < end; ++t) {
          HalfEdge e = corners[t];
          for (const std::size_t opposite :
               {2U, 0U, 1U}) {  // the first side lies opposite to the last vertex
            const HalfEdge across = HalfEdges::twin(e);
            neighbours[3 * t + opposite] =
                is_outer(across) ? -1 : triangle_of[static_cast<std::size_t>(across)];
            e = mesh_.edges.next_left(e);
          }
        }
      },
      monitor);
}

}  // namespace vorotool::core
