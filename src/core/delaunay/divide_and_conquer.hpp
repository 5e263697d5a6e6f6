// Delaunay triangulation by divide and conquer (Guibas and Stolfi 1985; cuts in both directions: Dwyer 1987).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/delaunay/vertex_links.hpp"

namespace vorotool::core::delaunay {

// Points in Morton order with the code of each; points of equal codes are together, in any order.
struct OrderedPoints {
  std::span<RingVertex> vertices;       // [n] distinct points; may be permuted within equal codes
  std::span<std::uint32_t> index;       // [n] permuted along
  std::span<const std::uint32_t> code;  // [n] not decreasing: bits of x and y in turn, x the higher of two
  std::span<const std::uint32_t> fine;  // [n] the same among points of equal code; or empty
};

// Further results of the construction. The ring of a vertex on the hull begins with the
// next vertex of the hull, counter-clockwise, and ends with the one before: the unbounded face follows its
// last neighbor.
struct Subdivision {
  std::vector<RingStore> stores;  // of long rings: to be kept along with the vertices
  Vertex start = -1;              // lexicographically smallest; none if there are no points
  bool is_chain = true;           // fewer than three or collinear points: a chain of edges
};

// Makes the rings of the Delaunay triangulation of the points, in which every cocircular polygon is a fan
// from its lexicographically smallest vertex.
Subdivision divide_and_conquer(const OrderedPoints& ordered, unsigned threads, const base::Monitor& monitor);

// Permutes points of equal code as divide_and_conquer does, for triangulations made in another way: then
// equal triangulations have equal numbers.
void permute_equal_codes(const OrderedPoints& ordered);

}  // namespace vorotool::core::delaunay
