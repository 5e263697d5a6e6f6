// Points and segments of a planar straight-line graph on an integer lattice, the input of the segment Voronoi
// diagram (paper, section 3.2), and differences of points.
#pragma once

#include <cstdint>

#include "core/kernel/point.hpp"

namespace vorotool::core::kernel {

// |x| and |y| are at most this: differences of coordinates fit in 32 bits with their sign, and a sum of two
// products of differences is at most 2 (2^31 - 2)^2 < 2^63, so that cross and dot products fit in 64.
inline constexpr std::int32_t lattice_limit = (1 << 30) - 1;

struct LatticePoint {
  std::int32_t x, y;

  friend bool operator==(const LatticePoint&, const LatticePoint&) = default;
};

// A point where a == b, else the open segment between a and b.
struct LatticeSite {
  LatticePoint a, b;

  bool is_point() const { return a == b; }
  bool is_end(const LatticePoint& p) const { return p == a || p == b; }
  friend bool operator==(const LatticeSite&, const LatticeSite&) = default;
};

// Differences of lattice points; their products are exact in 64 bits.
struct LatticeVector {
  std::int64_t x, y;
};

inline LatticeVector operator-(const LatticePoint& a, const LatticePoint& b) {
  return {std::int64_t{a.x} - b.x, std::int64_t{a.y} - b.y};
}
inline LatticeVector operator-(const LatticeVector& v) { return {-v.x, -v.y}; }

inline std::int64_t cross(const LatticeVector& v, const LatticeVector& w) { return v.x * w.y - v.y * w.x; }
inline std::int64_t dot(const LatticeVector& v, const LatticeVector& w) { return v.x * w.x + v.y * w.y; }
inline std::int64_t norm2(const LatticeVector& v) { return dot(v, v); }
// Turned by 90 degrees, counter-clockwise.
inline LatticeVector left_of(const LatticeVector& v) { return {-v.y, v.x}; }

}  // namespace vorotool::core::kernel
