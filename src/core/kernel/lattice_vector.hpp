// Differences of lattice points, and their products: exact in 64 bits (core/kernel/lattice_point.hpp).
#pragma once

#include <cstdint>

#include "core/kernel/lattice_point.hpp"

namespace vorotool::core::kernel {

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
