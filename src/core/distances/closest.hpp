// The smallest distance between two sets.
#pragma once

#include "core/distances/shape.hpp"

namespace vorotool::core::distances {

struct Closest {
  double distance;     // -1 where there is nothing
  kernel::Point on_a;  // a place of the first shape,
  kernel::Point on_b;  // and the nearest one of the second
};

// The smallest distance between places of two shapes: 0 where they meet, which is decided exactly, whether by
// their points and segments or since one lies inside a polygon of the other. Of several pairs of elements at
// the same distance, those with the smallest numbers are taken, first in the first shape.
Closest closest_places(const Shape& a, const Shape& b, unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::distances
