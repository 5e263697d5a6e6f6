// Elementary functions by basic operations only: the same bits on every machine, as no library of these
// gives.
//
// Sums, products, quotients and square roots are rounded alike everywhere; sines, arcs and hypot are not.
// These are the functions of numeric/curves/inverse_functions.py, operation by operation.
#pragma once

namespace vorotool::core::numbers {

// The length of (x, y), wrong by less than a unit in the last place; infinite where either is.
//
// The root of the sum of the squares is improved by one step of Newton's method, in which what the squares
// lost by rounding is found again (Borges 2019, "An Improved Algorithm for hypot(a,b)"); powers of two keep
// squares in range.
double hypotenuse(double x, double y);

// The angle of (x, y) from the first axis towards the second, for y >= 0: from 0 to pi, within a few
// roundings.
double angle_of(double x, double y);

// The inverse of the hyperbolic sine, of what is finite and not negative.
double inverse_sinh(double z);

}  // namespace vorotool::core::numbers
