// Whether the lune of an edge of a Delaunay triangulation is empty: the places that are nearer to each of its
// ends than these are to each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/delaunay/triangulation.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::proximity {

// A power of two that brings the largest coordinate near to 1.
double scale_of(std::span<const kernel::Point> points);

// One a thread: it keeps memory between two searches. A triangulation whose indices have been checked.
//
// From the triangles at the edge the search goes on through every side that the lune may meet, until it finds
// a point inside or no further triangle: it takes time in proportion to the triangles that meet the lune, of
// which there are few, unless the lune is found to be not empty at once. A point inside is seen from the edge
// through triangles that meet the lune, since that is convex.
class EmptyLunes {
 public:
  // `scale` is that of its points.
  EmptyLunes(const delaunay::TriangulationArrays& mesh, double scale) : mesh_(mesh), scale_(scale) {}

  // Of the edge that is this side, 3 t + k, of a triangle.
  bool is_empty(std::int32_t side);

 private:
  struct Lune;

  // Goes through a side, and puts the sides beyond it on the list. Whether it found a point inside the lune.
  bool finds_inside(const Lune& lune, std::size_t side);
  bool may_meet(const Lune& lune, std::size_t side) const;

  const delaunay::TriangulationArrays& mesh_;
  double scale_;
  std::vector<std::size_t> sides_;       // to go through
  std::vector<std::int32_t> triangles_;  // that have been looked at
};

}  // namespace vorotool::core::proximity
