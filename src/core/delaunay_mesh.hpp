// Delaunay triangulation of points in the plane (paper, section 2.1).
//
// Cocircular points: each cocircular polygon is a fan from its lexicographically smallest vertex. The result
// depends on the points alone: permuting them permutes their numbers, and the order of triangles and edges
// stays.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/divide_and_conquer.hpp"
#include "core/monitor.hpp"
#include "core/point_order.hpp"
#include "core/predicates.hpp"

namespace vorotool::core {

class DelaunayMesh {
 public:
  // Finite points. Throws std::length_error for more than 2^28 of them.
  DelaunayMesh(std::span<const Point> points, unsigned threads, const Monitor& monitor);

  // [n] for each point the first one at the same place: itself if it is the only one.
  std::span<const std::int32_t> first() const { return first_; }
  // [h] points on the hull, counter-clockwise from the lexicographically smallest; of fewer than three or
  // collinear points, from end to end.
  std::span<const std::int32_t> hull() const { return hull_; }
  std::size_t edge_count() const { return edge_count_; }
  // By Euler's relation for a connected planar graph.
  std::size_t triangle_count() const { return edge_count_ == 0 ? 0 : edge_count_ + 1 - order_.points.size(); }

  // [2 edge_count] ends of each edge, the smaller index first; of fewer than three or collinear points, of a
  // chain.
  void write_edges(std::int32_t* edges, unsigned threads, const Monitor& monitor) const;
  // [3 triangle_count] points of each triangle, counter-clockwise; and, unless null, the triangle across the
  // side opposite to each of them, -1 on the hull.
  void write_triangles(std::int32_t* triangles, std::int32_t* neighbours, unsigned threads,
                       const Monitor& monitor) const;

 private:
  struct Counts {
    std::size_t triangles = 0, edges = 0;
  };

  void walk_hull();
  void choose_starts();
  bool is_outer(HalfEdge e) const { return outer_[static_cast<std::size_t>(e)]; }
  std::int32_t given(Vertex v) const {
    return static_cast<std::int32_t>(order_.index[static_cast<std::size_t>(v)]);
  }
  template <class Visit>
  void visit_piece(std::size_t piece, Visit visit) const;
  void link_triangles(const std::vector<HalfEdge>& corners, const std::int32_t* triangle_of,
                      std::int32_t* neighbours, unsigned threads, const Monitor& monitor) const;

  MortonOrder order_;
  Subdivision mesh_;
  std::vector<std::int32_t> first_;
  std::vector<std::int32_t> hull_;
  std::vector<bool> outer_;      // [half-edges] the unbounded face is on its left
  std::vector<HalfEdge> start_;  // [vertices] the half-edge that leaves towards the earliest neighbour
  std::vector<Counts> before_;   // [pieces] what belongs to the vertices before each piece
  std::size_t edge_count_ = 0;
};

}  // namespace vorotool::core
