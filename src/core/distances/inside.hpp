// Whether what is inside polygons goes farther from another set than their outlines do.
#pragma once

#include <cstddef>

#include "core/distances/shape.hpp"

namespace vorotool::core::distances {

// False only if no place inside the polygons of a shape is farther than `least` from another shape, which is
// not empty. Squares of the plane are halved until they are known to hold no such place, one is found, or
// `most` of them have been looked at: then it may be so.
bool may_go_farther_inside(const Shape& of, const Shape& to, double least, std::size_t most,
                           const base::Monitor& monitor);

}  // namespace vorotool::core::distances
