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

#include "core/kernel/point.hpp"
#include "core/numbers/sign.hpp"

namespace vorotool::core::kernel {

static_assert(std::numeric_limits<double>::is_iec559 && FLT_EVAL_METHOD == 0);

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
inline constexpr double orient2d_bound = (3 + 32 * numbers::unit_roundoff) * numbers::unit_roundoff;

inline constexpr double underflow_scale = 0x1p-1020;

inline int orient2d_filter(const Point& a, const Point& b, const Point& c) {
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double determinant = left - right;
  const double permanent = std::abs(left) + std::abs(right);
  const double bound = orient2d_bound * (permanent + underflow_scale);
  return std::abs(determinant) > bound ? numbers::sign_of(determinant) : numbers::undecided;
}

// A point as it is seen from the ends l and r of an edge: with L = l - p and R = r - p, the sine and the
// cosine of the angle from L to R, times the lengths of both.
struct Apex {
  double cross, dot;                      // L.x R.y - L.y R.x and L.x R.x + L.y R.y
  double cross_permanent, dot_permanent;  // sums of the absolute products, and `underflow_guard`
};

// The angle is larger inside a circle through l and r than on it, so for p and q to the left of l r
//   D = dot(p) cross(q) - cross(p) dot(q)
// is positive if q lies inside the circle through l, r and p. As polynomials D and the determinant of the
// circle are the same: each vanishes where the four points are cocircular, and both have degree four.
//
// Bounds: a cross or dot product has two monomials, each with four roundings at most (two differences, the
// product, the sum), its permanent P the same and that of the guard g, and each product may underflow by h.
//   |cross - C| <= P ((1 + u)^4 - 1) (1 - u)^-5 + 2 h (1 + u) <= P (4 u + 27 u^2) + 3 h
// A factor k = 4 u + 64 u^2 loses 4 u^2 P in the rounding of k P; what is left, 33 u^2 P >= 33 u^2 g, is
// above 3 h, since P >= g = 2^-450. A monomial of D meets 4 + 4 roundings, one in the product and one in the
// difference, and one of P = dot_permanent(p) cross_permanent(q) + cross_permanent(p) dot_permanent(q) two
// more for the guards:
//   |det - D| <= P ((1 + u)^10 - 1) (1 - u)^-12 + underflow <= P (10 u + 180 u^2) + underflow
// With e = 3 h for what cross and dot lose to underflow and S the sum of the four permanents, that is at most
// (e S + 2 e^2 + 2 h) (1 + 4 u). A factor k = 10 u + 256 u^2 leaves 60 u^2 P, and as permanents are at least
// g, P >= g S / 2 and P >= 2 g^2: 30 u^2 P >= 15 u^2 g S > 2 e S, and 30 u^2 P >= 60 u^2 g^2 > 2^-1001 > 4 h.
inline constexpr double underflow_guard = 0x1p-450;
inline constexpr double cross_bound = (4 + 64 * numbers::unit_roundoff) * numbers::unit_roundoff;
inline constexpr double incircle_bound = (10 + 256 * numbers::unit_roundoff) * numbers::unit_roundoff;

inline Apex seen_from(const Point& l, const Point& r, const Point& p) {
  const double lx = l.x - p.x, ly = l.y - p.y, rx = r.x - p.x, ry = r.y - p.y;
  const double xy = lx * ry, yx = ly * rx, xx = lx * rx, yy = ly * ry;
  return {xy - yx, xx + yy, std::abs(xy) + std::abs(yx) + underflow_guard,
          std::abs(xx) + std::abs(yy) + underflow_guard};
}

// The sign of orient2d(l, r, p) for a point seen from l and r. Where the products cannot have been rounded,
// since the permanent is at most `exact`, zero is one as well.
inline int side_filter(const Apex& p, double exact = 0) {
  if (std::abs(p.cross) > cross_bound * p.cross_permanent || p.cross_permanent <= exact)
    return numbers::sign_of(p.cross);
  return numbers::undecided;
}

// The sign of incircle(l, r, p, q) for points seen from l and r; likewise.
inline int incircle_filter(const Apex& p, const Apex& q, double exact = 0) {
  const double determinant = p.dot * q.cross - p.cross * q.dot;
  const double permanent = p.dot_permanent * q.cross_permanent + p.cross_permanent * q.dot_permanent;
  if (std::abs(determinant) > incircle_bound * permanent || permanent <= exact)
    return numbers::sign_of(determinant);
  return numbers::undecided;
}

inline int incircle_filter(const Point& a, const Point& b, const Point& c, const Point& d) {
  return incircle_filter(seen_from(a, b, c), seen_from(a, b, d));
}

// Sign of the area of the triangle a, b, c: 1 if it is counter-clockwise (y upwards), -1 if clockwise, 0 if
// the points are collinear.
inline int orient2d(const Point& a, const Point& b, const Point& c) {
  const int sign = orient2d_filter(a, b, c);
  return sign != numbers::undecided ? sign : orient2d_beyond_filter(a, b, c);
}

// 1 if d is inside the circle through the counter-clockwise a, b, c, -1 outside, 0 on it; the opposite if a,
// b, c are clockwise.
inline int incircle(const Point& a, const Point& b, const Point& c, const Point& d) {
  const int sign = incircle_filter(a, b, c, d);
  return sign != numbers::undecided ? sign : incircle_beyond_filter(a, b, c, d);
}

// The stages beyond the filter, one by one, for predicates.cpp and the tests. Each gives the sign, or
// `undecided` for points that it is not made for; the wide one decides all.

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
