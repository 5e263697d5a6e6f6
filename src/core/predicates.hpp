// Exact signs of the two determinants that decide a Delaunay triangulation.
//
// Both predicates are right for all finite doubles, subnormal and huge ones mixed. A filter in floating
// point, inline here, settles nearly every call; predicates.cpp has the rest. The arithmetic must be IEEE 754
// double precision, rounding to nearest, with gradual underflow, and no product contracted into a fused
// operation.
#pragma once

#include <cfloat>
#include <cmath>
#include <limits>

namespace vorotool::core {

static_assert(std::numeric_limits<double>::is_iec559 && FLT_EVAL_METHOD == 0);

struct Point {
  double x, y;
};

// What a level of the predicates gives where it cannot tell the sign.
inline constexpr int undecided = 2;

// The signs beyond the filters, for any finite points.
int orient2d_beyond_filter(const Point& a, const Point& b, const Point& c);
int incircle_beyond_filter(const Point& a, const Point& b, const Point& c, const Point& d);

// The bounds of the filters. u = 2^-53 bounds the relative error of a rounding. Sums and differences have no
// other error: one that is subnormal is exact. A product that underflows has an absolute error besides, of at
// most half the smallest subnormal, h = 2^-1075. An overflow anywhere makes the bound infinite or NaN, and
// nothing is greater than that: the filter leaves the call undecided.
//
// orient2d: l = fl(L) for a product L of two differences carries three roundings, so
//   |l - L| <= |l| ((1 - u)^-3 - 1) + h (1 - u)^-3 <= |l| (3 u + 7 u^2) + h (1 + 4 u),   likewise r for R,
// and |l| + |r| <= P (1 + u) for P = fl(|l| + |r|), |l - r| >= |det| (1 - u) for det = fl(l - r). The sign of
// det is that of L - R if |l - r| > |l - L| + |r - R|, for which it is enough that
//   |det| > P (3 u + 14 u^2) + 2 h (1 + 6 u).
// The bound as computed, fl(k fl(P + 2^-1020)), loses at most a factor (1 - u)^2 and h. With k = 3 u + 32 u^2
// it is at least P (3 u + 25 u^2) + (12 (1 - 2 u) - 1) h, for 2^-1020 u = 4 h: enough for both terms.
inline constexpr double unit_roundoff = 0x1p-53;
inline constexpr double orient2d_bound = (3 + 32 * unit_roundoff) * unit_roundoff;

// incircle: the determinant is a sum of 12 monomials, each a square times a product of two differences. One
// meets at most 11 roundings: 4 differences, 1 square, 1 product, 1 sum of squares, 1 difference of
// products, 1 product of both, and 2 sums. P is computed by the same operations on absolute values, so
// without underflow, S being the exact sum of the absolute monomials,
//   |det - D| <= S ((1 + u)^11 - 1) and P >= S (1 - u)^11, hence |det - D| <= P (11 u + 180 u^2).
// Underflow puts at most 2 h (1 + u) into each lift and each minor, and h into each product of both. With T
// the sum of the lifts, and the sum of the absolute products in the minors at most T as well (each difference
// is in two of them, and |p q| <= (p^2 + q^2) / 2), it puts at most
//   (2 h T + 2 h T + 3 h) (1 + 20 u) < 8 h (T + 1)
// into det, and as much into P, where a factor k makes it vanish. The bound as computed,
// fl(k fl(P + fl(2^-1020 fl(T + 1)))), loses at most a factor (1 - u)^6, T having two roundings, and h. With
// k = 11 u + 256 u^2 it is at least P (11 u + 185 u^2) + (43 (T + 1) - 1) h: enough for both terms.
inline constexpr double incircle_bound = (11 + 256 * unit_roundoff) * unit_roundoff;
inline constexpr double underflow_scale = 0x1p-1020;

inline int sign_of(double value) { return (value > 0) - (value < 0); }

inline int orient2d_filter(const Point& a, const Point& b, const Point& c) {
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double determinant = left - right;
  const double permanent = std::abs(left) + std::abs(right);
  const double bound = orient2d_bound * (permanent + underflow_scale);
  return std::abs(determinant) > bound ? sign_of(determinant) : undecided;
}

inline int incircle_filter(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double ax = a.x - d.x, bx = b.x - d.x, cx = c.x - d.x;
  const double ay = a.y - d.y, by = b.y - d.y, cy = c.y - d.y;
  const double a_lift = ax * ax + ay * ay, b_lift = bx * bx + by * by, c_lift = cx * cx + cy * cy;
  const double bc = bx * cy, cb = cx * by, ca = cx * ay, ac = ax * cy, ab = ax * by, ba = bx * ay;
  const double determinant = a_lift * (bc - cb) + b_lift * (ca - ac) + c_lift * (ab - ba);
  const double permanent = a_lift * (std::abs(bc) + std::abs(cb)) + b_lift * (std::abs(ca) + std::abs(ac)) +
                           c_lift * (std::abs(ab) + std::abs(ba));
  const double underflow = underflow_scale * (a_lift + b_lift + c_lift + 1);
  const double bound = incircle_bound * (permanent + underflow);
  return std::abs(determinant) > bound ? sign_of(determinant) : undecided;
}

// Sign of the area of the triangle a, b, c: 1 if it is counter-clockwise (y upwards), -1 if clockwise, 0 if
// the points are collinear.
inline int orient2d(const Point& a, const Point& b, const Point& c) {
  const int sign = orient2d_filter(a, b, c);
  return sign != undecided ? sign : orient2d_beyond_filter(a, b, c);
}

// 1 if d is inside the circle through the counter-clockwise a, b, c, -1 outside, 0 on it; the opposite if a,
// b, c are clockwise.
inline int incircle(const Point& a, const Point& b, const Point& c, const Point& d) {
  const int sign = incircle_filter(a, b, c, d);
  return sign != undecided ? sign : incircle_beyond_filter(a, b, c, d);
}

}  // namespace vorotool::core
