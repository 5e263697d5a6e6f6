// Radii of supports, and obtuse angles, by integers as long as it takes: what is left where floating point
// cannot tell.
#pragma once

#include "core/alpha/critical_radius.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::alpha {

// Sign of the difference of the radii.
int compare_exactly(const Support& p, const Support& q);

// The double nearest to the radius, ties to even.
double round_exactly(const Support& support);

// Whether the angle at p between a and b is more than 90 degrees.
bool is_obtuse_exactly(const kernel::Point& a, const kernel::Point& b, const kernel::Point& p);

}  // namespace vorotool::core::alpha
