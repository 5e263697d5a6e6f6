// The places where Voronoi diagrams have vertices, correctly rounded; the exact order of distances, and the
// exact kind of angles.
//
// All are right for any finite doubles. Coincident places are the same doubles, whichever sites they are
// computed from, since each coordinate is the double nearest to the exact one.
#pragma once

#include "core/kernel/point.hpp"
#include "core/numbers/rounded_quotient.hpp"

namespace vorotool::core::kernel {

struct RoundedPoint {
  numbers::Rounded x, y;
};

// The center of the circle through three points that are not collinear. The first leaves the sign of an error
// undecided where 106 bits do not tell it; the second never does.
RoundedPoint circumcenter(const Point& a, const Point& b, const Point& c);
RoundedPoint circumcenter_exactly(const Point& a, const Point& b, const Point& c);

// The y of the place on the line of this x that is equidistant from two points, which have different y.
double bisector_at(double x, const Point& a, const Point& b);

// The sign of |q - a| - |q - b|: -1 if a is nearer to q, 1 if b is, 0 if they are equally near.
int compare_distances(const Point& q, const Point& a, const Point& b);

// The sign of (a - p) (b - p): -1 if the angle at p is more than 90 degrees, so that p is strictly inside the
// disc with diameter a b, 0 if p is on its circle, 1 outside.
int angle_sign(const Point& p, const Point& a, const Point& b);

}  // namespace vorotool::core::kernel
