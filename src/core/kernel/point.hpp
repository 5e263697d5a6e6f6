// A point of the plane, or a vector.
#pragma once

#include <cmath>

#include "core/numbers/elementary.hpp"

namespace vorotool::core::kernel {

struct Point {
  double x, y;

  friend bool operator==(const Point&, const Point&) = default;
};

inline Point operator-(const Point& p, const Point& q) { return {p.x - q.x, p.y - q.y}; }
inline double cross(const Point& v, const Point& w) { return v.x * w.y - v.y * w.x; }
inline double dot(const Point& v, const Point& w) { return v.x * w.x + v.y * w.y; }
// Where squares are in range, as they are on the lattice.
inline double norm(const Point& v) { return std::sqrt(dot(v, v)); }
// Of any points, within an ulp.
inline double distance(const Point& p, const Point& q) { return numbers::hypotenuse(p.x - q.x, p.y - q.y); }

// By x, then by y: the order in which a line sweeps over points of either kind, and by which one of several
// is the first. Without branches, as what sorts by it wants.
template <class AnyPoint>
bool lexicographic_less(const AnyPoint& p, const AnyPoint& q) {
  return (p.x < q.x) | (!(q.x < p.x) & (p.y < q.y));
}

}  // namespace vorotool::core::kernel
