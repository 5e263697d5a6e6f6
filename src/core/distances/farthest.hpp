// How far a set goes from another one: the directed Hausdorff distance, along its points and segments.
#pragma once

#include <cstdint>

#include "core/distances/shape.hpp"

namespace vorotool::core::distances {

struct Farthest {
  double distance;     // -1 where there is nothing
  kernel::Point from;  // of the first shape, a place that far from the second one
  kernel::Point on;    // of the second shape, the place nearest to it
};

// The largest distance from a place on the points and segments of one shape to the nearest place of another,
// which is not empty; what is inside the other is at distance 0. Of several places that far, an end of the
// first element that has one at an end is taken, if there is any. The result does not depend on the number
// of threads.
//
// The distance from one element is convex along a segment: it is largest at an end of each part of it. So
// the largest distance from all is at most what it is from the nearest at either end; and where one element
// is the nearest at both, it is the larger of the two. Else it is asked what is nearest at the place that is
// as far from the one as from the other: if nothing is nearer than these, the largest distance is there or
// at an end; if something is, both parts are looked at in the same way. Each step finds another piece of
// what is nearest, so there are not more of them than pieces. Segments come by their bounds, the largest
// first, until none is beyond what was found.
Farthest farthest_place(const Shape& from, const Shape& to, unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::distances
