// Where segments between lattice points cross: exact rational points, their order, and their lattice cells.
#pragma once

#include <cstdint>

#include "core/kernel/lattice.hpp"
#include "core/numbers/sign.hpp"

namespace vorotool::core::arrangement {

struct LatticeSegment {
  kernel::LatticePoint a, b;
};

// Twice the area of a, b, c: positive if they turn left. In 64 bits, see lattice_limit.
inline std::int64_t turn(kernel::LatticePoint a, kernel::LatticePoint b, kernel::LatticePoint c) {
  const std::int64_t ux = std::int64_t{b.x} - a.x, uy = std::int64_t{b.y} - a.y;
  const std::int64_t vx = std::int64_t{c.x} - a.x, vy = std::int64_t{c.y} - a.y;
  return ux * vy - uy * vx;
}

// The point (x + fraction_x / denominator, y + fraction_y / denominator), with
// 0 <= fractions < denominator < 2^63.
struct RationalPoint {
  std::int32_t x, y;
  std::uint64_t fraction_x, fraction_y, denominator;

  bool is_lattice_point() const { return fraction_x == 0 && fraction_y == 0; }

  // The lattice point c whose cell [c - 1/2, c + 1/2) in both directions holds this point.
  kernel::LatticePoint nearest() const {
    const auto up = [&](std::uint64_t fraction) { return fraction >= denominator - fraction ? 1 : 0; };
    return {x + up(fraction_x), y + up(fraction_y)};
  }
};

// -1, 0, 1 as p is before, at or after q in lexicographic order.
int compare(const RationalPoint& p, const RationalPoint& q);
int compare(const RationalPoint& p, kernel::LatticePoint q);

// The common point of the lines through two segments that are not parallel; it must lie on both segments.
RationalPoint crossing_of(const LatticeSegment& s, const LatticeSegment& t);

// 1 if p lies left of the line from s.a to s.b, -1 right of it, 0 on it.
int side_of(const LatticeSegment& s, const RationalPoint& p);
inline int side_of(const LatticeSegment& s, kernel::LatticePoint p) {
  return numbers::sign_of(turn(s.a, s.b, p));
}

// Whether a segment meets the cell [c - 1/2, c + 1/2) x [c - 1/2, c + 1/2) of a lattice point.
bool meets_cell(const LatticeSegment& s, kernel::LatticePoint c);

}  // namespace vorotool::core::arrangement
