// Points and segments of a planar straight-line graph on an integer lattice: the input of the segment Voronoi
// diagram (paper, section 3.2).
#pragma once

#include <cstdint>

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
  friend bool operator==(const LatticeSite&, const LatticeSite&) = default;
};

}  // namespace vorotool::core::kernel
