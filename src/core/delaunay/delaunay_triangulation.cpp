#include "core/delaunay/delaunay_triangulation.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/base/parallel.hpp"

namespace vorotool::core::delaunay {

using base::Monitor;
using base::parallel_for;

namespace {

constexpr std::size_t most_points = std::size_t{1} << 28;  // six half-edges a point are counted in 32 bits
constexpr int piece_bits = 14;                             // vertices of a piece, some 0.5 ms of work
constexpr std::size_t piece_size = std::size_t{1} << piece_bits;
constexpr std::uint32_t no_slot = 0xffffffff;  // fewer than 2^29 triangles, times four, stay below

Vertex neighbor(Vertex entry) { return entry < 0 ? ~entry : entry; }

}  // namespace

DelaunayTriangulation::DelaunayTriangulation(std::span<const kernel::Point> points, unsigned threads,
                                             const Monitor& monitor,
                                             const std::optional<spatial::Bounds>& within)
    : DelaunayTriangulation(
          points, [&](const OrderedPoints& ordered) { return divide_and_conquer(ordered, threads, monitor); },
          threads, monitor, within) {}

DelaunayTriangulation::DelaunayTriangulation(std::span<const kernel::Point> points,
                                             const Triangulate& triangulate, unsigned threads,
                                             const Monitor& monitor,
                                             const std::optional<spatial::Bounds>& within)
    : first_(points.size()) {
  if (points.size() > most_points) throw std::length_error("more than 268435456 points");
  MortonOrder order = morton_order(points, first_, FineOrder::of_crowds, threads, monitor, within);
  index_ = std::move(order.index);
  const std::span<RingVertex> vertices{order.vertices.data(), index_.size()};
  const Subdivision mesh = triangulate({vertices, index_, order.code, order.fine});
  walk_hull(mesh, vertices);
  gather_rings(vertices, threads, monitor);
}

// Lists the hull, and marks in the rings where the unbounded face follows.
void DelaunayTriangulation::walk_hull(const Subdivision& mesh, std::span<RingVertex> vertices) {
  Vertex from = -1;
  for (Vertex v = mesh.start; v >= 0;) {
    outline_.push_back(v);
    hull_.push_back(given(v));
    RingVertex& vertex = vertices[static_cast<std::size_t>(v)];
    Vertex next = mesh.start;
    for (Vertex& entry : std::span(vertex.ring(), vertex.degree())) {
      if (mesh.is_chain && entry != from) next = entry;
      if (mesh.is_chain) entry = ~entry;
    }
    if (!mesh.is_chain) {
      next = vertex.front();
      Vertex& last = vertex.ring()[vertex.degree() - 1];
      last = ~last;
    }
    from = v;
    v = next == mesh.start ? -1 : next;
  }
}

void DelaunayTriangulation::gather_rings(std::span<const RingVertex> vertices, unsigned threads,
                                         const Monitor& monitor) {
  ring_end_.resize(vertices.size());
  edge_start_.resize(vertices.size());
  pieces_.resize(base::piece_count(vertices.size(), piece_size) + 1);
  const auto gather = [&](std::size_t piece) { pieces_[piece] = gather_piece(piece, vertices); };
  parallel_for(pieces_.size() - 1, threads, gather, monitor);
  std::size_t triangles = 0;
  for (Piece& piece : pieces_) {
    edge_count_ += std::exchange(piece.edges, edge_count_);
    triangles += std::exchange(piece.triangles, triangles);
  }
}

DelaunayTriangulation::Piece DelaunayTriangulation::gather_piece(std::size_t number,
                                                                 std::span<const RingVertex> vertices) {
  const std::size_t begin = number << piece_bits;
  const std::size_t end = std::min(vertices.size(), begin + piece_size);
  std::size_t entries = 0;
  for (std::size_t place = begin; place < end; ++place) entries += vertices[place].degree();
  Piece piece{base::LargeArray<Vertex>(entries)};
  Vertex* next = piece.rings.data();
  for (std::size_t place = begin; place < end; ++place) {
    const auto v = static_cast<Vertex>(place);
    const std::span ring(vertices[place].ring(), vertices[place].degree());
    std::size_t from = 0;
    for (std::size_t k = 1; k < ring.size(); ++k) from = neighbor(ring[k]) < neighbor(ring[from]) ? k : from;
    edge_start_[place] = static_cast<std::uint32_t>(piece.edges);
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vertex entry = ring[from];
      from = from + 1 == ring.size() ? 0 : from + 1;
      const Vertex w = neighbor(entry);
      *next++ = entry;
      piece.edges += w > v;
      piece.triangles += (w > v) & (neighbor(ring[from]) > v) & (entry >= 0);
    }
    ring_end_[place] = static_cast<std::uint32_t>(next - piece.rings.data());
  }
  return piece;
}

std::span<const Vertex> DelaunayTriangulation::ring(Vertex v) const {
  const auto place = static_cast<std::size_t>(v);
  const std::size_t begin = place % piece_size == 0 ? 0 : ring_end_[place - 1];
  return {pieces_[place >> piece_bits].rings.data() + begin, ring_end_[place] - begin};
}

// A triangle is written at its earliest vertex v: what links it to its neighbors.
struct DelaunayTriangulation::Lead {
  Vertex w, u;                   // the others
  std::uint32_t edge_w, edge_u;  // numbers of the edges to them
};

// Triangles and edges are written vertex by vertex, each at its earliest vertex, in the order of the ring: an
// order that depends on the points alone. Calls visit(v, w, u, the edge from v to w, that to u, whether the
// edge to w is written here, whether the triangle v, w, u is).
template <class Visit>
void DelaunayTriangulation::visit_spokes(std::size_t piece, Visit visit) const {
  const std::size_t end = std::min(index_.size(), (piece + 1) << piece_bits);
  for (std::size_t place = piece << piece_bits; place < end; ++place) {
    const auto v = static_cast<Vertex>(place);
    const std::span<const Vertex> spokes = ring(v);
    const auto first = static_cast<std::uint32_t>(first_edge(v));
    std::uint32_t edge = first;
    Vertex entry = spokes[0];
    for (std::size_t k = 0; k < spokes.size(); ++k) {
      const bool last = k + 1 == spokes.size();
      const Vertex following = spokes[last ? 0 : k + 1];
      const Vertex w = neighbor(entry);
      const Vertex u = neighbor(following);
      const std::uint32_t next_edge = last ? first : edge + (w > v);
      visit(v, w, u, edge, next_edge, w > v, (w > v) & (u > v) & (entry >= 0));
      entry = following;
      edge = next_edge;
    }
  }
}

void DelaunayTriangulation::write(const MeshArrays& out, unsigned threads, const Monitor& monitor) const {
  if (edge_count_ == 0) return;
  const bool link = out.neighbors != nullptr && triangle_count() > 0;
  base::LargeArray<std::uint32_t> slots(link ? 2 * edge_count_ : 0);
  const auto write = [&](std::size_t piece) { write_piece(piece, out, link ? slots.data() : nullptr); };
  parallel_for(pieces_.size() - 1, threads, write, monitor);
  if (!link) return;
  for (std::size_t i = 0; i < outline_.size(); ++i) {
    slots[slot_of(outline_[i], outline_[i == 0 ? outline_.size() - 1 : i - 1])] = no_slot;
  }
  const auto put = [&](std::uint32_t slot, std::uint32_t across) {
    if (slot == no_slot) return;
    out.neighbors[3 * std::size_t{slot / 4} + slot % 4] =
        across == no_slot ? -1 : static_cast<std::int32_t>(across / 4);
  };
  base::for_items(edge_count_, piece_size, threads, monitor, [&](std::size_t edge) {
    put(slots[2 * edge], slots[2 * edge + 1]);
    put(slots[2 * edge + 1], slots[2 * edge]);
  });
}

// Every candidate is written, and the next one over it unless it counts: faster than a branch that cannot be
// foretold. At the end of a piece nothing more is written.
void DelaunayTriangulation::write_piece(std::size_t piece, const MeshArrays& out,
                                        std::uint32_t* slots) const {
  const std::size_t first = pieces_[piece].triangles;
  std::vector<Lead> leads(out.triangles ? pieces_[piece + 1].triangles - first : 0);
  std::size_t count = 0;
  std::int32_t* next = out.edges ? out.edges + 2 * pieces_[piece].edges : nullptr;
  const std::int32_t* last = out.edges ? out.edges + 2 * pieces_[piece + 1].edges : nullptr;
  visit_spokes(piece, [&](Vertex v, Vertex w, Vertex u, std::uint32_t edge_w, std::uint32_t edge_u, bool edge,
                          bool triangle) {
    const std::int32_t a = given(v), b = given(w);
    if (next != last) {
      next[0] = std::min(a, b);
      next[1] = std::max(a, b);
      next += edge ? 2 : 0;
    }
    if (count != leads.size()) {
      std::int32_t* corners = out.triangles + 3 * (first + count);
      corners[0] = a;
      corners[1] = b;
      corners[2] = given(u);
      leads[count] = {w, u, edge_w, edge_u};
      count += triangle;
    }
  });
  if (slots) fill_slots(leads, first, slots);
}

// The slot of a side is where the neighbor across it belongs: the triangle on its left, times four, and the
// corner opposite to it. An edge has two: first that of its direction from the earlier vertex.
void DelaunayTriangulation::fill_slots(const std::vector<Lead>& leads, std::size_t first,
                                       std::uint32_t* slots) const {
  for (std::size_t i = 0; i < leads.size(); ++i) {
    const auto [w, u, edge_w, edge_u] = leads[i];
    const auto slot = static_cast<std::uint32_t>(4 * (first + i));
    slots[2 * std::size_t{edge_w}] = slot + 2;
    slots[2 * std::size_t{edge_u} + 1] = slot + 1;
    slots[slot_of(w, u)] = slot;
  }
}

std::size_t DelaunayTriangulation::slot_of(Vertex from, Vertex to) const {
  return 2 * edge_between(std::min(from, to), std::max(from, to)) + (to < from);
}

std::size_t DelaunayTriangulation::first_edge(Vertex v) const {
  const auto place = static_cast<std::size_t>(v);
  return pieces_[place >> piece_bits].edges + edge_start_[place];
}

// The number of an edge: it is written at its earlier vertex.
std::size_t DelaunayTriangulation::edge_between(Vertex earlier, Vertex later) const {
  std::size_t edge = first_edge(earlier);
  for (const Vertex entry : ring(earlier)) {
    const Vertex w = neighbor(entry);
    if (w == later) break;
    edge += w > earlier;
  }
  return edge;
}

}  // namespace vorotool::core::delaunay
