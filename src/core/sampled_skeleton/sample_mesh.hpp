// The Delaunay triangulation of seeds, side by side.
//
// Side 3 t + k of triangle t is opposite to its corner k; t is on its left. Its Voronoi edge goes from the
// circumcentre of t to that of the neighbour across it, or to infinity.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/kernel/point.hpp"

namespace vorotool::core::sampled_skeleton {

using Side = std::int32_t;
using Triangle = std::int32_t;

// What is known of the Voronoi edge of a side; 0: it is kept.
enum SideState : std::uint8_t {
  same_label = 1,  // its seeds have a label in common
  own_piece = 2,  // its seeds follow each other on an edge, and it is all that the piece between them crosses
  crossed = 4,    // another piece meets it
};

struct SeedMesh {
  std::span<const kernel::Point> seeds;
  std::span<const std::int32_t> triangles, neighbours;  // [3 t] as of core/delaunay/triangulation.hpp

  std::size_t size() const { return triangles.size() / 3; }
  std::size_t sides() const { return triangles.size(); }
  const kernel::Point& seed(std::int32_t i) const { return seeds[static_cast<std::size_t>(i)]; }

  static Triangle triangle_of(Side s) { return s / 3; }
  std::int32_t corner(Triangle t, int k) const { return triangles[static_cast<std::size_t>(3 * t + k % 3)]; }
  std::int32_t origin(Side s) const {
    return triangles[static_cast<std::size_t>(s % 3 == 2 ? s - 2 : s + 1)];
  }
  std::int32_t target(Side s) const {
    return triangles[static_cast<std::size_t>(s % 3 == 0 ? s + 2 : s - 1)];
  }
  std::int32_t apex(Side s) const { return triangles[static_cast<std::size_t>(s)]; }
  // The triangle across a side, or -1.
  Triangle across(Side s) const { return neighbours[static_cast<std::size_t>(s)]; }
  // The same side of the triangle across it, or -1.
  Side twin(Side s) const {
    const Triangle u = across(s);
    if (u < 0) return -1;
    for (int k = 0; k < 2; ++k) {
      if (across(3 * u + k) == triangle_of(s)) return 3 * u + k;
    }
    return 3 * u + 2;
  }
  // Whether a side is the one of the two to be looked at where each is once.
  bool is_first(Side s) const { return across(s) < 0 || triangle_of(s) < across(s); }
};

}  // namespace vorotool::core::sampled_skeleton
