// Doubles onto the integer lattice of core/kernel/lattice.hpp by an exact power of two.
#pragma once

#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/kernel/lattice.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::arrangement {

// Lattice point c stands for (origin_x + c.x 2^exponent, origin_y + c.y 2^exponent), exactly.
//
// The exponent is the least (but for -1074, the step of all doubles) for which all points fit within
// lattice_limit of the origin: half the extent is then more than 2^28 steps. The origin is a double and a
// multiple of the step, near the middle. So points that lie on any lattice of a power of two that is no finer
// do not move at all: whole numbers do not, unless they span more than 2^31 - 2.
struct Placement {
  double origin_x = 0, origin_y = 0;
  int exponent = 0;
  std::vector<kernel::LatticePoint> points;  // the nearest lattice point of each point
  double largest_move = 0;  // of a point, in input units: 0 where none moved, else rounded up by a few ulp
};

// The points must be finite. The result does not depend on the number of threads.
Placement place_on_lattice(std::span<const kernel::Point> points, unsigned threads,
                           const base::Monitor& monitor);

}  // namespace vorotool::core::arrangement
