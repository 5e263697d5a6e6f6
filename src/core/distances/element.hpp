// Points and closed segments with any coordinates, and how far places are from them.
#pragma once

#include <cmath>

#include "core/kernel/point.hpp"

namespace vorotool::core::distances {

// A point where a == b, else the closed segment between a and b. Coordinates are at most 1e70 in magnitude:
// products of four of their differences are in range.
struct Element {
  kernel::Point a, b;

  bool is_point() const { return a == b; }

  // The place that has the share t of the way from a to b behind it; at 0 and 1 the ends themselves.
  kernel::Point at(double t) const {
    if (t <= 0.5) return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
    const double rest = 1 - t;
    return {b.x - rest * (b.x - a.x), b.y - rest * (b.y - a.y)};
  }
};

inline double square(const kernel::Point& v) { return kernel::dot(v, v); }

// The share of the way from a to b at which the place nearest to p is, from 0 to 1.
inline double nearest_share(const Element& e, const kernel::Point& p) {
  const kernel::Point along = e.b - e.a;
  const double length2 = square(along), t = kernel::dot(p - e.a, along);
  if (!(t > 0)) return 0;
  return t < length2 ? t / length2 : 1;
}

// Wrong by some ulp of the distances of p from the ends: across a segment it is seen from the nearer one. From
// segments along an axis it is as exact as from points.
inline double square_distance(const Element& e, const kernel::Point& p) {
  const kernel::Point along = e.b - e.a, from_a = p - e.a;
  const double length2 = square(along), t = kernel::dot(from_a, along);
  if (!(t > 0)) return square(from_a);
  const kernel::Point from_b = p - e.b;
  if (t >= length2) return square(from_b);
  if (along.x == 0) return from_a.x * from_a.x;
  if (along.y == 0) return from_a.y * from_a.y;
  const double across = kernel::cross(2 * t > length2 ? from_b : from_a, along);
  return across / length2 * across;
}

inline kernel::Point nearest_place(const Element& e, const kernel::Point& p) {
  const double share = nearest_share(e, p);
  if (share > 0 && share < 1) {
    if (e.a.x == e.b.x) return {e.a.x, p.y};
    if (e.a.y == e.b.y) return {p.x, e.a.y};
  }
  return e.at(share);
}

}  // namespace vorotool::core::distances
