// The triangles around each vertex of a triangulation given by arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "core/base/indices.hpp"
#include "core/delaunay/half_edge.hpp"
#include "core/delaunay/triangulation.hpp"

namespace vorotool::core::delaunay {

// Refuses indices that do not exist with std::invalid_argument.
void check_indices(const TriangulationArrays& mesh);

class VertexTriangles {
 public:
  // Refuses indices that do not exist with std::invalid_argument.
  explicit VertexTriangles(const TriangulationArrays& mesh);

  // Vertices of triangles in the order in which they first occur: neighbors are close together in it.
  std::span<const std::int32_t> order() const { return order_; }

  // Calls visit(triangle, next, last) for the triangles at a vertex v, counter-clockwise: v, next, last are
  // the corners. At the hull they begin with that whose side from v is on the hull. Returns whether v is
  // there.
  template <class Visit>
  bool visit(std::int32_t v, Visit visit) const {
    const std::int32_t start = first_[static_cast<std::size_t>(v)];
    if (start < 0) return true;
    std::int32_t t = start;
    for (std::size_t steps = 0; steps < triangles_; ++steps) {
      const std::size_t k = corner_of(t, v);
      visit(t, corner(t, following(k)), corner(t, preceding(k)));
      t = mesh_.neighbors[3 * base::at(t) + following(k)];
      if (t == start) return false;
      if (t < 0) return true;
    }
    throw std::invalid_argument("the triangles around a point form no ring");
  }

 private:
  std::int32_t corner(std::int32_t t, std::size_t k) const { return mesh_.triangles[3 * base::at(t) + k]; }
  std::size_t corner_of(std::int32_t t, std::int32_t v) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (corner(t, k) == v) return k;
    }
    throw std::invalid_argument("a triangle has a neighbor that does not share its side");
  }

  const TriangulationArrays& mesh_;
  std::size_t triangles_;
  std::vector<std::int32_t> first_;  // [n] triangle to begin with; -1 of points without
  std::vector<std::int32_t> order_;
};

}  // namespace vorotool::core::delaunay
