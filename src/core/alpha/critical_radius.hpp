// Radii at which the alpha shape of points changes (section 2.3): half the length of an edge, and the
// circumradius of a triangle. Both are square roots of rational numbers, correctly rounded here and compared
// exactly.
//
// Correct rounding is monotone: if the doubles of two radii differ, or the double of a radius and a number
// that is a double itself, then the exact values compare as they do. Only equal doubles leave a doubt.
#pragma once

#include "core/kernel/point.hpp"

namespace vorotool::core::alpha {

// An edge a, b, or a triangle a, b, c; finite points.
struct Support {
  kernel::Point a, b, c;
  bool is_triangle;
};

// The radius nearest to half the length or the circumradius, ties to even; infinite beyond the largest
// double, and for collinear points.
double critical_radius(const Support& support);

// Sign of the difference of the exact radii. That of collinear points is greater than any other.
int compare_radii(const Support& p, const Support& q);

// A triangle's circumradius, and the corner with an angle of more than 90 degrees, if there is one: 0, 1 or
// 2; else 3.
struct TriangleMeasure {
  double radius;
  int obtuse;
};
TriangleMeasure measure_triangle(const kernel::Point& a, const kernel::Point& b, const kernel::Point& c);

// Whether p is strictly inside the disc with diameter a, b: whether the angle at p is more than 90 degrees.
bool is_inside_diametral_disc(const kernel::Point& a, const kernel::Point& b, const kernel::Point& p);

}  // namespace vorotool::core::alpha
