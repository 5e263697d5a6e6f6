#include "core/kernel/circumcenter.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/kernel/predicates.hpp"
#include "core/numbers/double_double.hpp"
#include "core/numbers/dyadic_grid.hpp"
#include "core/numbers/expansion.hpp"
#include "core/numbers/fixed_integer.hpp"

namespace vorotool::core::kernel {

using numbers::DoubleDouble;
using numbers::DyadicGrid;
using numbers::Rounded;
using numbers::rounded_quotient;
using numbers::two_difference;
using numbers::undecided;
using numbers::unit_roundoff;

namespace {

// Numbers of 106 bits, with a bound of their error.

struct Estimate {
  DoubleDouble value;
  double error;
};

// Four factors of such magnitudes, and a quotient of three of them by two, lie between 2^-720 and 2^720, and
// the bounds of their errors above 2^-830: nothing below underflows or overflows.
bool is_moderate(double value) {
  const double magnitude = std::abs(value);
  return magnitude == 0 || (magnitude >= 0x1p-120 && magnitude <= 0x1p120);
}

constexpr double u2 = unit_roundoff * unit_roundoff;

// n / (2 d), where n and d are differences of products whose magnitudes add up to n_size and d_size.
//
// Products in n are of a difference, which is exact, and of a sum of squares: they have relative errors of at
// most (8 + 4 + 8) u^2, those in d of 8 u^2. With the last difference, and terms of higher order, n has an
// error of at most 26 u^2 n_size and d one of 14 u^2 d_size. While the latter is below 2^-20 |d|, the
// quotient q has at most
//   16 u^2 |q| + (26 u^2 n_size + |q| 28 u^2 d_size) (1 + 2^-19) / (2 |d|)
//     < 34 u^2 (n_size + |q| d_size) / |d|,
// since |d| <= d_size (1 + 2^-100). Added to the coordinate that it is relative to, a sum s, it gets 4 u^2
// |s| more. The bound below has 40 u^2 for both: the rest makes up for its own roundings, and that of error()
// below.
std::optional<Estimate> displaced(double origin, const DoubleDouble& n, double n_size, const DoubleDouble& d,
                                  double d_size) {
  if (!(std::abs(d.head) > 0x1p20 * 14 * u2 * d_size)) return {};
  const DoubleDouble quotient = n / DoubleDouble{2 * d.head, 2 * d.tail};
  const DoubleDouble sum = DoubleDouble{origin, 0} + quotient;
  const double size = (n_size + std::abs(quotient.head) * d_size) / std::abs(d.head) + std::abs(sum.head);
  return Estimate{sum, 40 * u2 * size};
}

// The estimate rounded, if all numbers within its error are rounded to the same double.
std::optional<Rounded> rounded(const std::optional<Estimate>& estimate) {
  if (!estimate) return {};
  const auto& [value, error] = *estimate;
  const double nearest = value.head + (value.tail - error);
  if (!(nearest == value.head + (value.tail + error))) return {};
  const double rest = (value.head - nearest) + value.tail;
  return Rounded{nearest, std::abs(rest) > 2 * error ? numbers::sign_of(rest) : undecided};
}

std::optional<RoundedPoint> circumcenter_by_estimate(const Point& a, const Point& b, const Point& c) {
  const DoubleDouble bx = two_difference(b.x, a.x), by = two_difference(b.y, a.y);
  const DoubleDouble cx = two_difference(c.x, a.x), cy = two_difference(c.y, a.y);
  for (const DoubleDouble& difference : {bx, by, cx, cy}) {
    if (!is_moderate(difference.head)) return {};
  }
  const DoubleDouble b_square = bx * bx + by * by, c_square = cx * cx + cy * cy;
  const auto minor = [](const DoubleDouble& p, const DoubleDouble& q, const DoubleDouble& r,
                        const DoubleDouble& s) {
    const DoubleDouble ps = p * s, qr = q * r;
    return std::pair{ps - qr, std::abs(ps.head) + std::abs(qr.head)};
  };
  const auto [d, d_size] = minor(bx, by, cx, cy);
  const auto [x, x_size] = minor(b_square, by, c_square, cy);
  const auto [y, y_size] = minor(bx, b_square, cx, c_square);
  const std::optional<Rounded> rounded_x = rounded(displaced(a.x, x, x_size, d, d_size));
  const std::optional<Rounded> rounded_y = rounded(displaced(a.y, y, y_size, d, d_size));
  if (!rounded_x || !rounded_y) return {};
  return RoundedPoint{*rounded_x, *rounded_y};
}

// (a.y + b.y) / 2 + (b.x - a.x) ((a.x - x) + (b.x - x)) / (2 (b.y - a.y)). The quotient q has a relative
// error of at most (4 + 8 + 16) u^2 and terms of higher order, and the sum s adds 4 u^2 |s|.
std::optional<Estimate> bisector_by_estimate(double x, const Point& a, const Point& b) {
  const DoubleDouble across = two_difference(b.x, a.x), along = two_difference(b.y, a.y);
  const DoubleDouble offset = two_difference(a.x, x) + two_difference(b.x, x);
  for (const double value : {across.head, along.head, offset.head, a.y, b.y}) {
    if (!is_moderate(value)) return {};
  }
  const DoubleDouble quotient = across * offset / DoubleDouble{2 * along.head, 2 * along.tail};
  const DoubleDouble twice = numbers::two_sum(a.y, b.y);
  const DoubleDouble sum = DoubleDouble{twice.head / 2, twice.tail / 2} + quotient;
  return Estimate{sum, 40 * u2 * (std::abs(quotient.head) + std::abs(sum.head))};
}

// Integers as long as it takes.

// Coordinates of 64 limbs - 3 bits: their differences are below 2^(64 limbs - 2) in magnitude, and a
// difference of twice one of them to the sum of two others below 2^(64 limbs - 1). Every result below has at
// least two bits less than its limbs, one of them for the sign.
constexpr int spare_bits_of_centers = 3;

// Calls body(the number of limbs, a constant) with enough of them for integers of so many bits.
template <class Body>
auto with_limbs(int bits, Body body) {
  if (bits + spare_bits_of_centers <= 64) return body(std::integral_constant<std::size_t, 1>{});
  if (bits + spare_bits_of_centers <= 4 * 64) return body(std::integral_constant<std::size_t, 4>{});
  if (bits + spare_bits_of_centers <= 12 * 64) return body(std::integral_constant<std::size_t, 12>{});
  static_assert(2098 + spare_bits_of_centers <= 33 * 64);
  return body(std::integral_constant<std::size_t, 33>{});
}

// Differences are below 2^(k - 2), k being the bits of the limbs; squares' sums below 2^(2 k - 3), d = 2
// (...) below 2^(2 k - 2), their products with a coordinate below 2^(3 k - 5), and numerators, sums of three
// such, below 2^(3 k - 3).
template <std::size_t limbs>
RoundedPoint circumcenter_in_limbs(const DyadicGrid& lattice, const Point& a, const Point& b,
                                   const Point& c) {
  const auto of = [&](double value) { return lattice.fixed_integer<limbs>(value); };
  const auto ax = of(a.x), ay = of(a.y);
  const auto bx = of(b.x) - ax, by = of(b.y) - ay, cx = of(c.x) - ax, cy = of(c.y) - ay;
  const auto b_square = bx * bx + by * by, c_square = cx * cx + cy * cy;
  const auto minor = bx * cy - by * cx;
  const auto d = minor + minor;
  const auto x = cy * b_square - by * c_square + ax * d;
  const auto y = bx * c_square - cx * b_square + ay * d;
  return {rounded_quotient(x, d, lattice.exponent), rounded_quotient(y, d, lattice.exponent)};
}

// The denominator is below 2^(k - 1), the numerator a sum of two products below 2^(2 k - 3).
template <std::size_t limbs>
double bisector_in_limbs(const DyadicGrid& lattice, double at, const Point& a, const Point& b) {
  const auto of = [&](double value) { return lattice.fixed_integer<limbs>(value); };
  const auto x = of(at), ax = of(a.x), ay = of(a.y), bx = of(b.x), by = of(b.y);
  const auto along = by - ay;
  const auto numerator = (ay + by) * along + (bx - ax) * ((ax - x) + (bx - x));
  return rounded_quotient(numerator, along + along, lattice.exponent).value;
}

template <std::size_t limbs>
int order_in_limbs(const DyadicGrid& lattice, const Point& q, const Point& a, const Point& b) {
  const auto of = [&](double value) { return lattice.fixed_integer<limbs>(value); };
  const auto qx = of(q.x), qy = of(q.y), ax = of(a.x), ay = of(a.y), bx = of(b.x), by = of(b.y);
  return ((bx - ax) * ((qx - ax) + (qx - bx)) + (by - ay) * ((qy - ay) + (qy - by))).sign();
}

// |q - a|^2 - |q - b|^2 = (b.x - a.x) ((q.x - a.x) + (q.x - b.x)), and the same of y. A monomial meets five
// roundings, and P, of the same operations on magnitudes, as many: the error is at most P (5 u + 60 u^2), and
// where products underflow h = 2^-1075 for each, twice. The bound as computed loses a factor (1 - u)^2 and h;
// with 2^-1020 u = 4 h it is at least P (5 u + 90 u^2) + 19 h, as for orient2d.
int order_by_filter(const Point& q, const Point& a, const Point& b) {
  constexpr double bound = (5 + 128 * unit_roundoff) * unit_roundoff;
  const double to_ax = q.x - a.x, to_bx = q.x - b.x, to_ay = q.y - a.y, to_by = q.y - b.y;
  const double across = b.x - a.x, along = b.y - a.y;
  const double difference = across * (to_ax + to_bx) + along * (to_ay + to_by);
  const double permanent = std::abs(across) * (std::abs(to_ax) + std::abs(to_bx)) +
                           std::abs(along) * (std::abs(to_ay) + std::abs(to_by));
  return std::abs(difference) > bound * (permanent + underflow_scale) ? numbers::sign_of(difference)
                                                                      : undecided;
}

template <std::size_t limbs>
int angle_in_limbs(const DyadicGrid& lattice, const Point& p, const Point& a, const Point& b) {
  const auto of = [&](double value) { return lattice.fixed_integer<limbs>(value); };
  const auto x = of(p.x), y = of(p.y);
  return ((of(a.x) - x) * (of(b.x) - x) + (of(a.y) - y) * (of(b.y) - y)).sign();
}

// Whether a b is a double, found where the last bits of the product are within range.
bool is_exact_product(double a, double b) {
  if (a == 0 || b == 0) return true;
  const double size = std::abs(a * b);
  return size > 0x1p-900 && size < 0x1p900 && std::abs(a) < 0x1p900 && std::abs(b) < 0x1p900 &&
         numbers::two_product(a, b, numbers::split(b)).tail == 0;
}

// The filter is that of orient2d: a sum of two products of two differences each, with the same rounding
// errors. Lattice points: where differences and products are exact, the sign of a sum of two doubles is
// right.
int angle_by_filter(const Point& p, const Point& a, const Point& b) {
  const numbers::TwoTerms ax = two_difference(a.x, p.x), ay = two_difference(a.y, p.y);
  const numbers::TwoTerms bx = two_difference(b.x, p.x), by = two_difference(b.y, p.y);
  const double left = ax.head * bx.head, right = ay.head * by.head;
  const double bound = orient2d_bound * (std::abs(left) + std::abs(right) + underflow_scale);
  if (std::abs(left + right) > bound) return numbers::sign_of(left + right);
  const bool is_short = ax.tail == 0 && ay.tail == 0 && bx.tail == 0 && by.tail == 0;
  return is_short && is_exact_product(ax.head, bx.head) && is_exact_product(ay.head, by.head)
             ? numbers::sign_of(left + right)
             : undecided;
}

}  // namespace

RoundedPoint circumcenter_exactly(const Point& a, const Point& b, const Point& c) {
  const DyadicGrid lattice(std::array{a.x, a.y, b.x, b.y, c.x, c.y});
  return with_limbs(lattice.bits, [&](auto limbs) { return circumcenter_in_limbs<limbs>(lattice, a, b, c); });
}

RoundedPoint circumcenter(const Point& a, const Point& b, const Point& c) {
  const std::optional<RoundedPoint> estimate = circumcenter_by_estimate(a, b, c);
  return estimate ? *estimate : circumcenter_exactly(a, b, c);
}

double bisector_at(double x, const Point& a, const Point& b) {
  if (const std::optional<Rounded> estimate = rounded(bisector_by_estimate(x, a, b))) return estimate->value;
  const DyadicGrid lattice(std::array{a.x, a.y, b.x, b.y, x});
  return with_limbs(lattice.bits, [&](auto limbs) { return bisector_in_limbs<limbs>(lattice, x, a, b); });
}

int compare_distances(const Point& q, const Point& a, const Point& b) {
  const int sign = order_by_filter(q, a, b);
  if (sign != undecided) return sign;
  const DyadicGrid lattice(std::array{q.x, q.y, a.x, a.y, b.x, b.y});
  return with_limbs(lattice.bits, [&](auto limbs) { return order_in_limbs<limbs>(lattice, q, a, b); });
}

int angle_sign(const Point& p, const Point& a, const Point& b) {
  const int sign = angle_by_filter(p, a, b);
  if (sign != undecided) return sign;
  const DyadicGrid lattice(std::array{p.x, p.y, a.x, a.y, b.x, b.y});
  return with_limbs(lattice.bits, [&](auto limbs) { return angle_in_limbs<limbs>(lattice, p, a, b); });
}

}  // namespace vorotool::core::kernel
