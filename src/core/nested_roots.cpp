#include "core/nested_roots.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/arithmetic.hpp"

namespace vorotool::core {
namespace {

using Terms = std::span<const BigInteger>;
using MutableTerms = std::span<BigInteger>;

bool is_zero(Terms terms) {
  return std::ranges::all_of(terms, [](const BigInteger& c) { return c.sign() == 0; });
}

Terms low_half(Terms terms) { return terms.first(terms.size() / 2); }
Terms high_half(Terms terms) { return terms.last(terms.size() / 2); }

std::vector<BigInteger> padded(Terms terms, std::size_t size) {
  std::vector<BigInteger> result(terms.begin(), terms.end());
  result.resize(size);
  return result;
}

// result += a b, all of the same level.
void add_product(const RootTower* tower, Terms a, Terms b, MutableTerms result) {
  if (is_zero(a) || is_zero(b)) return;
  if (a.size() == 1) {
    result[0] = result[0] + a[0] * b[0];
    return;
  }
  const std::size_t half = a.size() / 2;
  add_product(tower, low_half(a), low_half(b), result.first(half));
  add_product(tower, low_half(a), high_half(b), result.last(half));
  add_product(tower, high_half(a), low_half(b), result.last(half));
  std::vector<BigInteger> high(half);
  add_product(tower, high_half(a), high_half(b), high);
  const Terms radicand = tower->radicand(static_cast<std::size_t>(std::countr_zero(half))).coefficients();
  add_product(tower, high, padded(radicand, half), result.first(half));
}

// low^2 - a high^2, of the level below.
std::vector<BigInteger> norm(const RootTower* tower, Terms terms) {
  const std::size_t half = terms.size() / 2;
  std::vector<BigInteger> difference(half), negative(half), high(half);
  add_product(tower, high_half(terms), high_half(terms), high);
  for (std::size_t i = 0; i < half; ++i) negative[i] = -high[i];
  add_product(tower, low_half(terms), low_half(terms), difference);
  const Terms radicand = tower->radicand(static_cast<std::size_t>(std::countr_zero(half))).coefficients();
  add_product(tower, negative, padded(radicand, half), difference);
  return difference;
}

int sign_of(const RootTower* tower, Terms terms) {
  if (terms.size() == 1) return terms[0].sign();
  const int low = sign_of(tower, low_half(terms)), high = sign_of(tower, high_half(terms));
  if (low == 0 || high == 0 || low == high) return low != 0 ? low : high;
  return low * sign_of(tower, norm(tower, terms));
}

RootMagnitude normalized(uint128 mantissa, std::int64_t exponent) {
  const auto high = static_cast<std::uint64_t>(mantissa >> 64);
  const int zeros =
      high != 0 ? std::countl_zero(high) : 64 + std::countl_zero(static_cast<std::uint64_t>(mantissa));
  return {static_cast<std::uint64_t>(mantissa << zeros >> 64), exponent + 64 - zeros};
}

RootMagnitude magnitude_of(const RootTower* tower, Terms terms) {
  if (terms.size() == 1) {
    return {terms[0].leading_bits(), static_cast<std::int64_t>(terms[0].bits()) - 64};
  }
  const int low_sign = sign_of(tower, low_half(terms)), high_sign = sign_of(tower, high_half(terms));
  if (high_sign == 0) return magnitude_of(tower, low_half(terms));
  const std::size_t level = static_cast<std::size_t>(std::countr_zero(terms.size())) - 1;
  const RootMagnitude high =
      magnitude_of(tower, high_half(terms)) * square_root(magnitude(tower->radicand(level)));
  if (low_sign == 0) return high;
  const RootMagnitude sum = magnitude_of(tower, low_half(terms)) + high;
  return low_sign == high_sign ? sum : magnitude_of(tower, norm(tower, terms)) / sum;
}

}  // namespace

int RootNumber::sign() const { return sign_of(tower_, coefficients_); }

RootNumber RootNumber::operator-() const {
  RootNumber result = *this;
  for (BigInteger& c : result.coefficients_) c = -c;
  return result;
}

RootNumber operator+(const RootNumber& a, const RootNumber& b) {
  const bool a_longer = a.coefficients_.size() >= b.coefficients_.size();
  RootNumber result = a_longer ? a : b;
  const Terms other = a_longer ? b.coefficients_ : a.coefficients_;
  for (std::size_t i = 0; i < other.size(); ++i) {
    result.coefficients_[i] = result.coefficients_[i] + other[i];
  }
  return result;
}

RootNumber operator-(const RootNumber& a, const RootNumber& b) { return a + -b; }

RootNumber operator*(const RootNumber& a, const RootNumber& b) {
  const std::size_t size = std::max(a.coefficients_.size(), b.coefficients_.size());
  const RootTower* tower = a.tower_ != nullptr ? a.tower_ : b.tower_;
  RootNumber product(tower, std::vector<BigInteger>(size));
  add_product(tower, padded(a.coefficients_, size), padded(b.coefficients_, size), product.coefficients_);
  return product;
}

RootNumber RootTower::adjoin_root(const RootNumber& radicand) {
  radicands_.push_back(radicand);
  std::vector<BigInteger> coefficients(std::size_t{1} << depth());
  coefficients[coefficients.size() / 2] = 1;
  return RootNumber(this, std::move(coefficients));
}

RootNumber RootTower::lift(const RootNumber& number, std::size_t first) const {
  const Terms terms = number.coefficients();
  std::vector<BigInteger> coefficients(terms.size() << first);
  for (std::size_t i = 0; i < terms.size(); ++i) coefficients[i << first] = terms[i];
  return RootNumber(this, std::move(coefficients));
}

std::size_t RootTower::adjoin_all(const RootTower& other) {
  const std::size_t first = depth();
  for (const RootNumber& radicand : other.radicands_) adjoin_root(lift(radicand, first));
  return first;
}

double RootMagnitude::rounded() const {
  return std::ldexp(static_cast<double>(mantissa),
                    static_cast<int>(std::clamp<std::int64_t>(exponent, -5000, 5000)));
}

RootMagnitude magnitude(const RootNumber& number) {
  return magnitude_of(number.tower(), number.coefficients());
}

RootMagnitude operator*(const RootMagnitude& a, const RootMagnitude& b) {
  return normalized(uint128{a.mantissa} * b.mantissa, a.exponent + b.exponent);
}

RootMagnitude operator/(const RootMagnitude& a, const RootMagnitude& b) {
  return normalized((uint128{a.mantissa} << 63) / b.mantissa, a.exponent - b.exponent - 63);
}

RootMagnitude operator+(const RootMagnitude& a, const RootMagnitude& b) {
  const RootMagnitude& larger = a.exponent < b.exponent ? b : a;
  const RootMagnitude& smaller = a.exponent < b.exponent ? a : b;
  const std::int64_t shift = larger.exponent - smaller.exponent;
  return normalized(uint128{larger.mantissa} + (shift < 64 ? smaller.mantissa >> shift : 0), larger.exponent);
}

// The integer square root of mantissa 2^62 or 2^63, whichever leaves an even exponent: 63 or 64 bits, one a
// step.
RootMagnitude square_root(const RootMagnitude& a) {
  const int shift = a.exponent % 2 == 0 ? 62 : 63;
  const uint128 radicand = uint128{a.mantissa} << shift;
  std::uint64_t root = 0;
  for (std::uint64_t bit = std::uint64_t{1} << 63; bit != 0; bit >>= 1) {
    const std::uint64_t next = root | bit;
    if (uint128{next} * next <= radicand) root = next;
  }
  return normalized(root, (a.exponent - shift) / 2);
}

}  // namespace vorotool::core
