// Differences of lattice points, with exact products.
#pragma once

#include <cstdint>

#include "core/lattice.hpp"

namespace vorotool::core {

// Coordinates are at most 2^31 - 2 in magnitude, so that products of two vectors fit (core/lattice.hpp).
struct LatticeVector {
  std::int64_t x, y;

  LatticeVector operator-() const { return {-x, -y}; }
  LatticeVector left() const { return {-y, x}; }  // turned by 90 degrees, counter-clockwise
};

inline LatticeVector operator-(const LatticePoint& a, const LatticePoint& b) {
  return {std::int64_t{a.x} - b.x, std::int64_t{a.y} - b.y};
}
inline std::int64_t dot(const LatticeVector& a, const LatticeVector& b) { return a.x * b.x + a.y * b.y; }
inline std::int64_t cross(const LatticeVector& a, const LatticeVector& b) { return a.x * b.y - a.y * b.x; }
inline std::int64_t norm2(const LatticeVector& a) { return dot(a, a); }
inline int sign_of(std::int64_t value) { return (value > 0) - (value < 0); }

}  // namespace vorotool::core
