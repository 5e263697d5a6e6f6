// Delaunay triangulation by divide and conquer (Guibas and Stolfi 1985; cuts in both directions: Dwyer 1987).
#pragma once

#include <cstdint>
#include <span>

#include "core/half_edges.hpp"
#include "core/monitor.hpp"
#include "core/predicates.hpp"

namespace vorotool::core {

// Points in Morton order with the code of each; points of equal codes are together, in any order.
struct OrderedPoints {
  std::span<Point> points;              // [n] distinct; may be permuted within equal codes
  std::span<std::uint32_t> index;       // [n] permuted along
  std::span<const std::uint32_t> code;  // [n] not decreasing: bits of x and y in turn, x the higher of two
  std::span<const std::uint32_t> fine;  // [n] the same among points of equal code; or empty
};

// A Delaunay triangulation of the points. Vertices are positions in `points`; edges of fewer than three or of
// collinear points are a chain. Which diagonals are taken among cocircular points is left open.
struct Subdivision {
  HalfEdges edges{0};
  HalfEdge hull =
      no_edge;  // leaves its origin counter-clockwise along the hull; none for fewer than two points

  // Whether any predicate was zero. If none was, no four points of two neighbouring triangles are cocircular:
  // otherwise one of them could be moved a little, into the circle, and the same signs would have led to the
  // same edges, which then are not Delaunay.
  bool degenerate = false;
};

Subdivision divide_and_conquer(const OrderedPoints& ordered, unsigned threads, const Monitor& monitor);

// Permutes points of equal code as divide_and_conquer does, for triangulations made in another way: then
// equal triangulations have equal numbers.
void permute_equal_codes(const OrderedPoints& ordered);

}  // namespace vorotool::core
