// Radii of supports by integers as long as it takes: what is left where floating point cannot tell.
#pragma once

#include "core/alpha/critical_radius.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::alpha {

// Sign of the difference of the radii.
int compare_exactly(const Support& p, const Support& q);

// The double nearest to the radius, ties to even.
double round_exactly(const Support& support);

}  // namespace vorotool::core::alpha
