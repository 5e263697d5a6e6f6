#include "core/numbers/sqrt_tower.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "core/numbers/int128.hpp"
#include "core/numbers/sign.hpp"

namespace vorotool::core::numbers {
namespace {

using Terms = std::span<const BigInteger>;
using MutableTerms = std::span<BigInteger>;

bool is_zero(Terms terms) {
  return std::ranges::all_of(terms, [](const BigInteger& c) { return c.sign() == 0; });
}

Terms low_half(Terms terms) { return terms.first(terms.size() / 2); }
Terms high_half(Terms terms) { return terms.last(terms.size() / 2); }

// The radicand of the root that the higher half of 2 `half` coefficients has in common.
Terms radicand_of(const SqrtTower* tower, std::size_t half) {
  return tower->radicand(static_cast<std::size_t>(std::countr_zero(half))).coefficients();
}

// result += a b; the result has as many coefficients as the longer one, at least.
void add_product(const SqrtTower* tower, Terms a, Terms b, MutableTerms result) {
  if (is_zero(a) || is_zero(b)) return;
  if (a.size() < b.size()) std::swap(a, b);
  if (a.size() == 1) {
    result[0] += a[0] * b[0];
    return;
  }
  const std::size_t half = a.size() / 2;
  if (b.size() <= half) {
    add_product(tower, low_half(a), b, result.first(half));
    add_product(tower, high_half(a), b, result.subspan(half, half));
    return;
  }
  add_product(tower, low_half(a), low_half(b), result.first(half));
  add_product(tower, low_half(a), high_half(b), result.subspan(half, half));
  add_product(tower, high_half(a), low_half(b), result.subspan(half, half));
  RootTerms high(half);
  add_product(tower, high_half(a), high_half(b), high);
  add_product(tower, high, radicand_of(tower, half), result.first(half));
}

// low^2 - a high^2, of the level below.
RootTerms norm(const SqrtTower* tower, Terms terms) {
  const std::size_t half = terms.size() / 2;
  RootTerms difference(half), high(half);
  add_product(tower, high_half(terms), high_half(terms), high);
  for (BigInteger& c : MutableTerms(high)) c.negate();
  add_product(tower, low_half(terms), low_half(terms), difference);
  add_product(tower, high, radicand_of(tower, half), difference);
  return difference;
}

int sign_of(const SqrtTower* tower, Terms terms) {
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

RootMagnitude magnitude_of(const SqrtTower* tower, Terms terms) {
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

int RootNumber::sign() const { return sign_of(tower_, terms_); }

RootTerms::RootTerms(std::span<const BigInteger> terms, std::size_t size) : RootTerms(size) {
  std::ranges::copy(terms, std::span<BigInteger>(*this).begin());
}

void RootNumber::widen(std::size_t size) {
  if (size > terms_.size()) terms_ = RootTerms(terms_, size);
}

RootNumber RootNumber::operator-() const {
  RootNumber result = *this;
  for (BigInteger& c : MutableTerms(result.terms_)) c.negate();
  return result;
}

RootNumber operator+(RootNumber a, const RootNumber& b) {
  if (a.tower_ == nullptr) a.tower_ = b.tower_;
  a.widen(b.terms_.size());
  const MutableTerms sum(a.terms_);
  for (std::size_t i = 0; i < b.terms_.size(); ++i) sum[i] += b.coefficients()[i];
  return a;
}

RootNumber operator-(RootNumber a, const RootNumber& b) {
  if (a.tower_ == nullptr) a.tower_ = b.tower_;
  a.widen(b.terms_.size());
  const MutableTerms difference(a.terms_);
  for (std::size_t i = 0; i < b.terms_.size(); ++i) difference[i] -= b.coefficients()[i];
  return a;
}

RootNumber operator*(const RootNumber& a, const RootNumber& b) {
  const SqrtTower* tower = a.tower_ != nullptr ? a.tower_ : b.tower_;
  RootNumber product(tower, RootTerms(std::max(a.terms_.size(), b.terms_.size())));
  add_product(tower, a.terms_, b.terms_, product.terms_);
  return product;
}

RootNumber SqrtTower::adjoin_root(const RootNumber& radicand) {
  std::size_t level = depth();
  if (radicand.coefficients().size() == 1) {
    const BigInteger& number = radicand.coefficients()[0];
    if (const std::optional<BigInteger> root = integer_root(number)) return *root;
    const auto is_equal = [&](const RootNumber& other) {
      return other.coefficients().size() == 1 && other.coefficients()[0] == number;
    };
    level = static_cast<std::size_t>(std::ranges::find_if(radicands_, is_equal) - radicands_.begin());
  }
  if (level == depth()) radicands_.push_back(radicand);
  RootTerms terms(std::size_t{2} << level);
  const MutableTerms coefficients(terms);
  coefficients[terms.size() / 2] = 1;
  return RootNumber(this, std::move(terms));
}

std::vector<RootNumber> SqrtTower::adjoin_all(const SqrtTower& other) {
  std::vector<RootNumber> roots;
  for (const RootNumber& radicand : other.radicands_) roots.push_back(adjoin_root(lift(radicand, roots)));
  return roots;
}

RootNumber SqrtTower::lift(const RootNumber& number, std::span<const RootNumber> roots) {
  const Terms terms = number.coefficients();
  if (terms.size() == 1) return terms[0];
  const auto level = static_cast<std::size_t>(std::countr_zero(terms.size())) - 1;
  const auto half = [&](Terms part) { return lift(RootNumber(number.tower(), RootTerms(part)), roots); };
  return half(low_half(terms)) + half(high_half(terms)) * roots[level];
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

}  // namespace vorotool::core::numbers
