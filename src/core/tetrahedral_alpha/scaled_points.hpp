// Points as radii are measured of them.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/tetrahedra/point3.hpp"

namespace vorotool::core::tetrahedral_alpha {

using tetrahedra::Point3;

// Points moved and scaled, which changes radii by a power of two: to integers below 2^53 where all are on a common
// lattice that is fine enough, else, if nothing is lost by that, to coordinates below 2.
struct ScaledPoints {
  base::LargeArray<Point3> points;
  int exponent = 0;  // a radius is that of these points times 2^exponent
  bool are_integers = false;

  // The points of these numbers.
  ScaledPoints(std::span<const Point3> given, std::span<const std::int32_t> chosen, unsigned threads,
               const base::Monitor& monitor);
};

}  // namespace vorotool::core::tetrahedral_alpha
