// Delaunay triangulation of points in the plane (paper, section 2.1).
//
// Cocircular points: each cocircular polygon is a fan from its lexicographically smallest vertex. The result
// depends on the points alone: permuting them permutes their numbers, and the order of triangles and edges
// stays.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/delaunay/divide_and_conquer.hpp"
#include "core/delaunay/spatial_sort.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::delaunay {

// Where to write a mesh; null what is not wanted, neighbors only along with triangles.
struct MeshArrays {
  std::int32_t* triangles = nullptr;  // [3 triangle_count] points, counter-clockwise
  // [3 triangle_count] the triangle across the side opposite to each; or -1
  std::int32_t* neighbors = nullptr;
  // [2 edge_count] ends, the smaller index first; of collinear points, a chain
  std::int32_t* edges = nullptr;
};

class DelaunayTriangulation {
 public:
  // Finite points. Throws std::length_error for more than 2^28 of them. Triangles and edges are in an order
  // along the curve through `within`, if it is there: it holds all points.
  DelaunayTriangulation(std::span<const kernel::Point> points, unsigned threads, const base::Monitor& monitor,
                        const std::optional<spatial::Bounds>& within = {});

  // The same from the rings of divide_and_conquer that are made in another way, after permute_equal_codes.
  using Triangulate = std::function<Subdivision(const OrderedPoints&)>;
  DelaunayTriangulation(std::span<const kernel::Point> points, const Triangulate& triangulate,
                        unsigned threads, const base::Monitor& monitor,
                        const std::optional<spatial::Bounds>& within = {});
  DelaunayTriangulation(DelaunayTriangulation&&) = default;  // and no copy

  // [n] for each point the first one at the same place: itself if it is the only one.
  std::span<const std::int32_t> first() const { return first_; }
  // [h] points on the hull, counter-clockwise from the lexicographically smallest; of fewer than three or
  // collinear points, from end to end.
  std::span<const std::int32_t> hull() const { return hull_; }
  std::size_t edge_count() const { return edge_count_; }
  // By Euler's relation for a connected planar graph.
  std::size_t triangle_count() const { return edge_count_ == 0 ? 0 : edge_count_ + 1 - index_.size(); }

  void write(const MeshArrays& out, unsigned threads, const base::Monitor& monitor) const;

 private:
  // Vertices are numbered along the curve, and a piece of them is worked on at a time. The neighbors of
  // each, its ring, go counter-clockwise from the earliest one; ~w instead of w where the unbounded face
  // follows.
  struct Piece {
    base::LargeArray<Vertex> rings;
    std::size_t edges = 0, triangles = 0;  // of the piece; once all are made, of those before it
  };
  struct Lead;

  void walk_hull(const Subdivision& mesh, std::span<RingVertex> vertices);
  void gather_rings(std::span<const RingVertex> vertices, unsigned threads, const base::Monitor& monitor);
  Piece gather_piece(std::size_t piece, std::span<const RingVertex> vertices);

  std::int32_t given(Vertex v) const {
    return static_cast<std::int32_t>(index_[static_cast<std::size_t>(v)]);
  }
  std::span<const Vertex> ring(Vertex v) const;
  template <class Visit>
  void visit_spokes(std::size_t piece, Visit visit) const;
  void write_piece(std::size_t piece, const MeshArrays& out, std::uint32_t* slots) const;
  void fill_slots(const std::vector<Lead>& leads, std::size_t first, std::uint32_t* slots) const;
  std::size_t first_edge(Vertex v) const;
  std::size_t slot_of(Vertex from, Vertex to) const;
  std::size_t edge_between(Vertex earlier, Vertex later) const;

  std::vector<std::uint32_t> index_;  // [vertices] of the points given
  std::vector<std::int32_t> first_;
  std::vector<std::int32_t> hull_;
  std::vector<Vertex> outline_;            // the same as vertices
  std::vector<Piece> pieces_;              // one more than there are, with the totals
  std::vector<std::uint32_t> ring_end_;    // [vertices] in the rings of its piece
  std::vector<std::uint32_t> edge_start_;  // [vertices] edges of its piece before the first one written at it
  std::size_t edge_count_ = 0;
};

}  // namespace vorotool::core::delaunay
