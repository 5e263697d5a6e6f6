#include "core/alpha/critical_radius.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/alpha/exact_radius.hpp"
#include "core/kernel/circumcenter.hpp"
#include "core/numbers/double_double.hpp"
#include "core/numbers/expansion.hpp"
#include "core/numbers/int128.hpp"

namespace vorotool::core::alpha {

using kernel::Point;
using numbers::DoubleDouble;
using numbers::fast_two_sum;
using numbers::int128;
using numbers::two_difference;
using numbers::TwoTerms;

namespace {

constexpr double u = numbers::unit_roundoff;

// About 106 bits: sums of two doubles.
//
// In each operation the last bits of the factors' tails are left out, u^2 of the product, and what is added
// to a tail of a few u of the whole is rounded, a few times by u of the tail. For heads that are rounded sums
// of both parts that is less than 8 u^2 of a product, 16 u^2 of a sum of two squares, and 8 u^2 (|x| + |y|)
// for x - y where x and y are products of two such numbers, their own errors included: there the difference
// needs less care than that of core/numbers/double_double.hpp.

DoubleDouble two_square(double a) {
  const double head = a * a;
  const TwoTerms halves = numbers::split(a);
  const double error = (head - halves.head * halves.head) - 2 * (halves.tail * halves.head);
  return {head, halves.tail * halves.tail - error};
}

DoubleDouble sum_of_squares(const DoubleDouble& x, const DoubleDouble& y) {
  const DoubleDouble p = two_square(x.head), q = two_square(y.head);
  const TwoTerms sum = numbers::two_sum(p.head, q.head);
  return fast_two_sum(sum.head, sum.tail + ((p.tail + 2 * x.head * x.tail) + (q.tail + 2 * y.head * y.tail)));
}

DoubleDouble minus(const DoubleDouble& x, const DoubleDouble& y) {
  const TwoTerms sum = two_difference(x.head, y.head);
  return fast_two_sum(sum.head, sum.tail + (x.tail - y.tail));
}

struct Vector {
  DoubleDouble x, y;

  double extent() const { return std::max(std::abs(x.head), std::abs(y.head)); }
  DoubleDouble square() const { return sum_of_squares(x, y); }
  bool is_short() const { return x.tail == 0 && y.tail == 0; }
};

// Exact, unless it overflows.
Vector from_to(const Point& a, const Point& b) {
  return {two_difference(b.x, a.x), two_difference(b.y, a.y)};
}

// A number known to be within `error` of head + tail, where fl(head + tail) = head. Not known at all if the
// error is infinite.
struct Estimate {
  double head, tail, error;

  bool settles_rounding() const {
    return head + (tail + error) == head &&
           head + (tail - error) == head;  // false where the error is infinite
  }
};
constexpr Estimate unknown{0, 0, std::numeric_limits<double>::infinity()};

// Lengths of sides within these bounds let no product below overflow, or underflow to any effect: squares of
// three sides are within 2^-600 ... 2^603, and their last bits far above 2^-1074.
constexpr double shortest = 0x1p-100, longest = 0x1p100;
// The area must not be lost in underflow either, and cancellation must leave some forty bits of it.
constexpr double least_cross = 0x1p-300;
constexpr double worst_cancellation = 0x1p60;

bool is_in_range(const Vector& side) { return side.extent() >= shortest && side.extent() <= longest; }

// sqrt(n / d) by one step of Newton's method from the rounded root r of the heads, where x = |r^2 d / n - 1|
// is at most 6 u:
//   sqrt(n / d) = r (1 - x)^(-1/2) for n / d = r^2 / (1 - x), taken as r + (n - r^2 d) / (2 r d).
// The terms left out are below x^2 r <= 36 u^2 r, the residual carries 16 u^2 n of error from the products
// and a few u of its own size, and with a relative error of `before` u^2 in n / d the root is within
// (before / 2 + 8 + 36 + 36) u^2 r.
Estimate root_of_quotient(const DoubleDouble& n, const DoubleDouble& d, double before) {
  const double root = std::sqrt(n.head / d.head);
  const DoubleDouble product = two_square(root) * d;
  const double residual =
      (n.head - product.head) + (n.tail - product.tail);  // the heads' difference is exact
  const double step = residual / (2 * root * d.head);
  const TwoTerms sum = fast_two_sum(root, step);
  return {sum.head, sum.tail, (before / 2 + 80) * u * u * root};
}

// Half a length.
Estimate estimate_half_length(const Vector& side) {
  if (!is_in_range(side)) return unknown;
  return root_of_quotient(side.square(), {4, 0}, 20);
}

// The lengths of the sides and the cross product of two of them.
struct Triangle {
  Vector ab, ac, bc;
  std::array<DoubleDouble, 3> square{};  // of the side opposite to each corner

  Triangle(const Point& a, const Point& b, const Point& c)
      : ab(from_to(a, b)), ac(from_to(a, c)), bc(from_to(b, c)) {}

  bool in_range() const { return is_in_range(ab) && is_in_range(ac) && is_in_range(bc); }
  void measure() { square = {bc.square(), ac.square(), ab.square()}; }
};

// R^2 = |ab|^2 |ac|^2 |bc|^2 / (4 cross^2). The squares carry 20 u^2 each, the numerator with its two
// products 76 u^2. The cross product l - r carries 8 u^2 (|l| + |r|), at most 16 k u^2 of it with
// k = (|l| + |r|) / |cross|, and the denominator carries (32 k + 8) u^2.
Estimate estimate_circumradius(const Triangle& t) {
  const DoubleDouble left = t.ab.x * t.ac.y, right = t.ab.y * t.ac.x;
  const DoubleDouble cross = minus(left, right);
  const double size = std::abs(cross.head);
  const double terms = std::abs(left.head) + std::abs(right.head);
  if (!(size >= least_cross) || !(terms <= size * worst_cancellation)) return unknown;
  const DoubleDouble squares = t.square[0] * t.square[1] * t.square[2];
  const DoubleDouble cross2 = cross * cross;
  return root_of_quotient(squares, {4 * cross2.head, 4 * cross2.tail}, 76 + 8 + 33 * (terms / size));
}

Estimate estimate(const Support& s) {
  if (!s.is_triangle) return estimate_half_length(from_to(s.a, s.b));
  Triangle triangle(s.a, s.b, s.c);
  if (!triangle.in_range()) return unknown;
  triangle.measure();
  return estimate_circumradius(triangle);
}

// The support times a power of two that brings it into the range, if it is out of it because it is large or
// small as a whole; the radius is to be multiplied by the inverse. Products with powers of two are exact here
// unless a coordinate becomes subnormal; then none is found.
struct Rescaled {
  Support support;
  int exponent;  // the power of two taken out; 0 if there is none
};

Rescaled rescale(const Support& s) {
  std::array<double, 6> values{s.a.x, s.a.y, s.b.x, s.b.y, s.c.x, s.c.y};
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  if (largest == 0) return {s, 0};
  const int exponent = std::ilogb(largest);
  for (double& value : values) {
    const double moved = std::ldexp(value, -exponent);
    if (std::ldexp(moved, exponent) != value) return {s, 0};
    value = moved;
  }
  return {{{values[0], values[1]}, {values[2], values[3]}, {values[4], values[5]}, s.is_triangle}, exponent};
}

// Small integers: points of a lattice.

// Differences below 2^11 in magnitude, so those of the third side are below 2^12. Squares are below 2^23,
// 2^23 and 2^25, the numerator below 2^71, the cross product below 2^23 and the denominator below 2^48:
// products of both are below 2^119.
constexpr double most_short = 2048;

struct ShortSquare {
  int128 numerator = 0, denominator = 0;
  bool is_known = false;
};

ShortSquare short_square(const Support& s) {
  const auto fits = [](const Vector& v) {
    const auto is_small = [](double d) {
      return std::abs(d) < most_short && static_cast<double>(static_cast<int>(d)) == d;
    };
    return v.is_short() && is_small(v.x.head) && is_small(v.y.head);
  };
  const Vector ab = from_to(s.a, s.b);
  if (!fits(ab)) return {};
  const auto ux = static_cast<std::int64_t>(ab.x.head), uy = static_cast<std::int64_t>(ab.y.head);
  if (!s.is_triangle) return {ux * ux + uy * uy, 4, true};
  const Vector ac = from_to(s.a, s.c);
  if (!fits(ac)) return {};
  const auto vx = static_cast<std::int64_t>(ac.x.head), vy = static_cast<std::int64_t>(ac.y.head);
  const std::int64_t wx = vx - ux, wy = vy - uy, cross = ux * vy - uy * vx;
  if (cross == 0) return {};
  return {int128{(ux * ux + uy * uy) * (vx * vx + vy * vy)} * (wx * wx + wy * wy), int128{4 * cross * cross},
          true};
}

// Supports that are one another moved, turned by quarters or mirrored.

// The sides of a support, each as the larger and the smaller of |dx| and |dy|, in increasing order; known
// where the differences are exact. Equal ones have equal radii.
struct Shape {
  std::array<std::pair<double, double>, 3> side{};
  bool is_known = false;
};

Shape shape_of(const Support& s) {
  Shape shape;
  const auto put = [&](std::size_t k, const Vector& v) {
    const double x = std::abs(v.x.head), y = std::abs(v.y.head);
    shape.side[k] = {std::max(x, y), std::min(x, y)};
    return v.is_short();
  };
  shape.is_known = put(0, from_to(s.a, s.b));
  if (s.is_triangle) {
    shape.is_known &= put(1, from_to(s.a, s.c));
    shape.is_known &= put(2, from_to(s.b, s.c));
    std::sort(shape.side.begin(), shape.side.end());
  }
  return shape;
}

bool are_alike(const Support& p, const Support& q) {
  if (p.is_triangle != q.is_triangle) return false;
  const Shape a = shape_of(p), b = shape_of(q);
  return a.is_known && b.is_known && a.side == b.side;
}

// Errors of the heads of the squares are at most (1 + 20 u) u of them; those of the two sums make it less
// than 4 u of all three.
int obtuse_corner(const Triangle& t, const std::array<const Point*, 3>& corner) {
  const auto& s = t.square;
  const double doubt = 4 * u * (s[0].head + s[1].head + s[2].head);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const double excess = s[k].head - (s[i].head + s[j].head);
    if (excess < -doubt) continue;
    if (excess > doubt || is_inside_diametral_disc(*corner[i], *corner[j], *corner[k]))
      return static_cast<int>(k);
  }
  return 3;
}

double radius_beyond_estimate(const Support& s) {
  const Rescaled moved = rescale(s);
  if (moved.exponent != 0) {
    const Estimate found = estimate(moved.support);
    const double radius = std::ldexp(found.head, moved.exponent);
    // A power of two keeps the rounding right, unless the result is subnormal.
    if (found.settles_rounding() && radius >= std::numeric_limits<double>::min()) return radius;
  }
  return round_exactly(s);
}

}  // namespace

double critical_radius(const Support& support) {
  const Estimate found = estimate(support);
  return found.settles_rounding() ? found.head : radius_beyond_estimate(support);
}

int compare_radii(const Support& p, const Support& q) {
  const ShortSquare a = short_square(p);
  if (a.is_known) {
    const ShortSquare b = short_square(q);
    const int128 left = a.numerator * b.denominator, right = b.numerator * a.denominator;
    if (b.is_known) return (left > right) - (left < right);
  }
  const Estimate e = estimate(p), f = estimate(q);
  // The differences of the heads and of the tails are rounded: by u of themselves each.
  const double difference = (e.head - f.head) + (e.tail - f.tail);
  if (std::abs(difference) >
      2 * (e.error + f.error) + 4 * u * (std::abs(e.head - f.head) + std::abs(e.tail - f.tail))) {
    return numbers::sign_of(difference);
  }
  return are_alike(p, q) ? 0 : compare_exactly(p, q);
}

TriangleMeasure measure_triangle(const Point& a, const Point& b, const Point& c) {
  const std::array<const Point*, 3> corner{&a, &b, &c};
  Triangle triangle(a, b, c);
  if (triangle.in_range()) {
    triangle.measure();
    const Estimate found = estimate_circumradius(triangle);
    const int obtuse = obtuse_corner(triangle, corner);
    if (found.settles_rounding()) return {found.head, obtuse};
    return {radius_beyond_estimate({a, b, c, true}), obtuse};
  }
  int obtuse = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    if (is_inside_diametral_disc(*corner[(k + 1) % 3], *corner[(k + 2) % 3], *corner[k]))
      obtuse = static_cast<int>(k);
  }
  return {radius_beyond_estimate({a, b, c, true}), obtuse};
}

bool is_inside_diametral_disc(const Point& a, const Point& b, const Point& p) {
  return kernel::angle_sign(p, a, b) < 0;
}

}  // namespace vorotool::core::alpha
