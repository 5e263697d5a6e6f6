// Quotients of long integers as doubles, correctly rounded.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/numbers/fixed_integer.hpp"
#include "core/numbers/sign.hpp"

namespace vorotool::core::numbers {

// A number rounded to the nearest double, ties to even, and the side of it on which the number lies: rounding
// is monotonic, so both together compare the number with any double exactly.
struct Rounded {
  double value;
  int error_sign;  // of the number less the value; `undecided` where it is not known

  // The sign of the number less a double; `undecided` only if that is the value itself.
  int compare(double other) const { return value != other ? sign_of(value - other) : error_sign; }
};

template <std::size_t n>
int bit_width(const FixedInteger<n>& a) {
  for (std::size_t i = n; i-- > 0;) {
    if (a.limb[i] != 0) return static_cast<int>(64 * i) + std::bit_width(a.limb[i]);
  }
  return 0;
}

template <std::size_t n>
FixedInteger<n> shifted_left(const FixedInteger<n>& a, int bits) {
  const auto limbs = static_cast<std::size_t>(bits / 64);
  const int rest = bits % 64;
  FixedInteger<n> result;
  for (std::size_t i = limbs; i < n; ++i) {
    result.limb[i] = a.limb[i - limbs] << rest;
    if (rest != 0 && i > limbs) result.limb[i] |= a.limb[i - limbs - 1] >> (64 - rest);
  }
  return result;
}

// The same number in more limbs.
template <std::size_t to, std::size_t from>
FixedInteger<to> resized(const FixedInteger<from>& a) {
  static_assert(to >= from);
  FixedInteger<to> result;
  const std::uint64_t sign = a.is_negative() ? ~std::uint64_t{0} : 0;
  for (std::size_t i = 0; i < to; ++i) result.limb[i] = i < from ? a.limb[i] : sign;
  return result;
}

// The double nearest to (mantissa + a fraction) 2^exponent, for a positive mantissa of 55 bits; `more` tells
// that the fraction is not zero.
inline Rounded rounded_scaled(std::uint64_t mantissa, bool more, int exponent) {
  constexpr int width = 55, precision = 53, least_exponent = -1074;
  const int dropped =
      std::max(width - precision, least_exponent - exponent);  // subnormal doubles hold fewer bits
  if (dropped > width) return {0.0, 1};
  const std::uint64_t unit = std::uint64_t{1} << dropped;
  const std::uint64_t rest = mantissa & (unit - 1);
  const std::uint64_t half = unit / 2;
  std::uint64_t kept = mantissa >> dropped;
  const bool up = rest > half || (rest == half && (more || kept % 2 == 1));
  kept += up;
  const int error_sign = up ? -1 : static_cast<int>(rest != 0 || more);
  return {std::ldexp(static_cast<double>(kept), exponent + dropped), error_sign};
}

// numerator / denominator 2^exponent, rounded. The denominator is not zero; both are at least three bits
// shorter than their limbs, n >= m. What is beyond the largest double is infinite.
template <std::size_t n, std::size_t m>
Rounded rounded_quotient(FixedInteger<n> numerator, const FixedInteger<m>& denominator, int exponent) {
  const int sign = numerator.sign() * denominator.sign();
  if (sign == 0) return {0.0, 0};
  if (numerator.is_negative()) numerator = FixedInteger<n>{} - numerator;
  FixedInteger<n> divisor = resized<n>(denominator);
  if (divisor.is_negative()) divisor = FixedInteger<n>{} - divisor;
  // Aligned, their quotient lies between 1/2 and 2.
  const int shift = bit_width(numerator) - bit_width(divisor);
  if (shift > 0) divisor = shifted_left(divisor, shift);
  if (shift < 0) numerator = shifted_left(numerator, -shift);
  std::uint64_t mantissa = 0;
  int scale = exponent + shift + 1;
  while (mantissa >> 54 == 0) {  // long division, until there are 55 bits
    const FixedInteger<n> rest = numerator - divisor;
    const bool fits = !rest.is_negative();
    numerator = shifted_left(fits ? rest : numerator, 1);
    mantissa = 2 * mantissa + fits;
    --scale;
  }
  const Rounded result = rounded_scaled(mantissa, numerator.sign() != 0, scale);
  return {sign * result.value, sign * result.error_sign};
}

}  // namespace vorotool::core::numbers
