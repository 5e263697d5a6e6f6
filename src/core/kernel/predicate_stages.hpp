// The levels of the predicates beyond the filter, one by one, for predicates.cpp and the tests.
//
// Each gives the sign, or `undecided` for points that it is not made for; the wide level decides all.
#pragma once

#include "core/kernel/predicates.hpp"

namespace vorotool::core::kernel {

// Coordinates that are integers of at most 61 bits, but for a common power of two (in orient2d one for x, one
// for y).
int orient2d_integers(const Point& a, const Point& b, const Point& c);
int incircle_integers(const Point& a, const Point& b, const Point& c, const Point& d);

// Sums of doubles that keep every rounding error; coordinates whose magnitudes span at most 2^983
// (orient2d) or 2^464 (incircle).
int orient2d_expansions(const Point& a, const Point& b, const Point& c);
int incircle_expansions(const Point& a, const Point& b, const Point& c, const Point& d);

// Integers as long as it takes.
int orient2d_wide(const Point& a, const Point& b, const Point& c);
int incircle_wide(const Point& a, const Point& b, const Point& c, const Point& d);

}  // namespace vorotool::core::kernel
