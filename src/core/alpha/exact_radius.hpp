// Radii of supports by integers as long as it takes: what is left where floating point cannot tell.
#pragma once

#include "core/alpha/critical_radius.hpp"
#include "core/numbers/big_integer.hpp"

namespace vorotool::core::alpha {

// The square of a radius: numerator / denominator times 2^(2 exponent), both at least 0; a zero denominator stands
// for infinity.
struct SquaredRadius {
  numbers::BigInteger numerator, denominator;
  int exponent;
};

// Sign of the difference.
int compare(const SquaredRadius& p, const SquaredRadius& q);

// The double nearest to the root, ties to even.
double rounded_root(const SquaredRadius& square);

// Sign of the difference of the radii.
int compare_exactly(const Support& p, const Support& q);

// The double nearest to the radius, ties to even.
double round_exactly(const Support& support);

}  // namespace vorotool::core::alpha
