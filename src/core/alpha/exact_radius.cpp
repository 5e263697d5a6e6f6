#include "core/alpha/exact_radius.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/numbers/big_integer.hpp"
#include "core/numbers/dyadic_grid.hpp"

namespace vorotool::core::alpha {

using kernel::Point;
using numbers::BigInteger;

namespace {

BigInteger integer_of(double value, int exponent) {
  const numbers::OddMantissa parts(value);
  if (parts.mantissa == 0) return {};
  const BigInteger magnitude = BigInteger(parts.mantissa) << (parts.exponent - exponent);
  return parts.is_negative ? -magnitude : magnitude;
}

SquaredRadius exact_square(const Support& s) {
  const Point& third = s.is_triangle ? s.c : s.a;
  const std::array<double, 6> values{s.a.x, s.b.x, third.x, s.a.y, s.b.y, third.y};
  const int exponent = numbers::DyadicGrid(values).exponent;
  std::array<BigInteger, 6> at;
  for (std::size_t i = 0; i < 6; ++i) at[i] = integer_of(values[i], exponent);
  const auto [ax, bx, cx, ay, by, cy] = at;
  const auto square = [](const BigInteger& x, const BigInteger& y) { return x * x + y * y; };
  const BigInteger ux = bx - ax, uy = by - ay, vx = cx - ax, vy = cy - ay;
  if (!s.is_triangle) return {square(ux, uy), 4, exponent};
  const BigInteger cross = ux * vy - uy * vx;
  return {square(ux, uy) * square(vx, vy) * square(vx - ux, vy - uy), cross * cross << 2, exponent};
}

// Sign of p n / (p d) times 2^(2 shift) less q.
int compare_quotients(const BigInteger& pn, const BigInteger& pd, const BigInteger& qn, const BigInteger& qd,
                      int shift) {
  if (pd.sign() == 0 || qd.sign() == 0) return int{pd.sign() == 0} - int{qd.sign() == 0};
  const BigInteger left = pn * qd, right = qn * pd;
  return shift >= 0 ? compare(left << 2 * shift, right) : compare(left, right << -2 * shift);
}

}  // namespace

int compare(const SquaredRadius& p, const SquaredRadius& q) {
  return compare_quotients(p.numerator, p.denominator, q.numerator, q.denominator, p.exponent - q.exponent);
}

int compare_exactly(const Support& p, const Support& q) { return compare(exact_square(p), exact_square(q)); }

// A mantissa of at most 53 bits times 2^exponent, found from the leading bits and set right by comparing with
// the midpoints around it.
double rounded_root(const SquaredRadius& square) {
  if (square.denominator.sign() == 0) return std::numeric_limits<double>::infinity();
  if (square.numerator.sign() == 0) return 0;
  int power = static_cast<int>(square.numerator.bits()) - static_cast<int>(square.denominator.bits()) +
              2 * square.exponent;
  double quotient = static_cast<double>(square.numerator.leading_bits()) /
                    static_cast<double>(square.denominator.leading_bits());
  if (power % 2 != 0) {
    quotient *= 2;
    --power;
  }
  const double root = std::sqrt(quotient);  // in [2^-1/2, 2)
  const int exponent = std::max(power / 2 + std::ilogb(root) - 52, -1074);
  auto mantissa = static_cast<std::uint64_t>(std::ldexp(root, power / 2 - exponent));
  // sign of the radius less half * 2^(exponent - 1)
  const auto compare_with = [&](std::uint64_t half) {
    return compare_quotients(square.numerator, square.denominator, BigInteger(half) * BigInteger(half), 1,
                             square.exponent - (exponent - 1));
  };
  for (int sign = 1; sign > 0;) {
    sign = compare_with(2 * mantissa + 1);
    if (sign > 0 || (sign == 0 && mantissa % 2 != 0)) ++mantissa;
  }
  for (int sign = -1; sign < 0 && mantissa > 0;) {
    sign = compare_with(2 * mantissa - 1);
    if (sign < 0 || (sign == 0 && mantissa % 2 != 0)) --mantissa;
  }
  return std::ldexp(static_cast<double>(mantissa), exponent);
}

double round_exactly(const Support& s) { return rounded_root(exact_square(s)); }

}  // namespace vorotool::core::alpha
