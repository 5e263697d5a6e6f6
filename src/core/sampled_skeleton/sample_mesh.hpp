// The Delaunay triangulation of seeds, side by side, and differences of seeds.
//
// A side has its triangle on its left. Its Voronoi edge goes from the
// circumcenter of t to that of the neighbor across it, or to infinity.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/indices.hpp"
#include "core/delaunay/half_edge.hpp"
#include "core/kernel/point.hpp"
#include "core/numbers/int128.hpp"
#include "core/numbers/sign.hpp"
#include "core/sampled_skeleton/boundary_samples.hpp"

namespace vorotool::core::sampled_skeleton {

using Side = delaunay::HalfEdge;  // opposite to its corner
using Triangle = std::int32_t;

// Flags of the Voronoi edge of a side; 0: it is kept.
enum SideState : std::uint8_t {
  same_label = 1,  // its seeds have a label in common
  own_piece = 2,  // its seeds follow each other on an edge, and it is all that the piece between them crosses
  crossed = 4,    // another piece meets it
};

struct SampleMesh {
  std::span<const kernel::Point> seeds;
  std::span<const std::int32_t> triangles, neighbors;  // [3 t] as of core/delaunay/triangulation.hpp

  std::size_t size() const { return triangles.size() / 3; }
  std::size_t sides() const { return triangles.size(); }
  const kernel::Point& seed(std::int32_t i) const { return seeds[static_cast<std::size_t>(i)]; }

  static Triangle triangle_of(Side s) { return s / 3; }
  std::int32_t origin(Side s) const { return apex(delaunay::following(s)); }
  std::int32_t target(Side s) const { return apex(delaunay::preceding(s)); }
  std::int32_t apex(Side s) const { return triangles[base::at(s)]; }
  // The side of a triangle that is opposite to one of its corners.
  Side opposite(Triangle t, std::int32_t corner) const {
    Side s = 3 * t;
    while (apex(s) != corner) ++s;
    return s;
  }
  // The triangle across a side, or -1.
  Triangle across(Side s) const { return neighbors[base::at(s)]; }
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

// Differences of seeds, and exact products of them. Coordinates are multiples of `seed_step` below 2^30
// (core/sampled_skeleton/boundary_samples.hpp): differences are below 2^53 of these, products of two below
// 2^106, sums of two products below 2^107.
struct SampleVector {
  std::int64_t x, y;
};

inline SampleVector sample_difference(const kernel::Point& a, const kernel::Point& b) {
  return {static_cast<std::int64_t>((a.x - b.x) / seed_step),
          static_cast<std::int64_t>((a.y - b.y) / seed_step)};
}
inline SampleVector operator+(const SampleVector& v, const SampleVector& w) { return {v.x + w.x, v.y + w.y}; }
inline numbers::int128 dot(const SampleVector& v, const SampleVector& w) {
  return numbers::int128{v.x} * w.x + numbers::int128{v.y} * w.y;
}
inline SampleVector left_of(const SampleVector& v) { return {-v.y, v.x}; }

// The sign of the angle at p between a and b less 90 degrees, exactly: 1 if it is smaller.
inline int sign_of_dot(const kernel::Point& p, const kernel::Point& a, const kernel::Point& b) {
  // differences are exact, two products and a sum rounded
  const double x = (a.x - p.x) * (b.x - p.x), y = (a.y - p.y) * (b.y - p.y), sum = x + y;
  if (std::abs(sum) > 4 * numbers::unit_roundoff * (std::abs(x) + std::abs(y))) return numbers::sign_of(sum);
  const numbers::int128 exact = dot(sample_difference(a, p), sample_difference(b, p));
  return (exact > 0) - (exact < 0);
}

}  // namespace vorotool::core::sampled_skeleton
