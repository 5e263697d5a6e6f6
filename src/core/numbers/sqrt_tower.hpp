// Numbers built from integers by +, -, * and square roots that may be nested, and their exact signs.
//
// A tower is a list of radicands a_0, a_1, ...: positive numbers, each made of integers and the roots of
// those before it. A number of level k is low + high sqrt(a_(k-1)) with low and high of level k - 1; a number
// of level 0 is an integer. Written out it is an integer combination of the 2^k products of the roots.
//
// The sign needs no approximation and no separation bound: if low and high sqrt(a) have opposite signs, then
// the larger of low^2 and a high^2 decides, and that difference is of level k - 1. This holds for any real
// numbers: roots may be integers, equal, or dependent.
//
// Sizes: let |x| be the sum of the absolute values of all terms of x, each root taken as the square root of
// |a|. Then |x + y| <= |x| + |y|, |x y| <= |x| |y|, no integer in x exceeds |x|, and
// |low^2 - a high^2| <= |x|^2: the sign of a number of level k meets integers of at most |x|^(2^k).
// No level is added for a root that is an integer, nor for the root of an integer that has one already. So
// where lengths are commensurable, as those of parallel, mirrored and congruent segments are, numbers stay
// short.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/numbers/big_integer.hpp"

namespace vorotool::core::numbers {

class SqrtTower;

// The coefficients of the products of roots: 1, 2, 4, ... integers, of which two take no memory.
class RootTerms {
 public:
  explicit RootTerms(std::size_t size) : size_(size), more_(size > few ? size : 0) {}
  explicit RootTerms(std::span<const BigInteger> terms) : RootTerms(terms, terms.size()) {}
  // Followed by zeros.
  RootTerms(std::span<const BigInteger> terms, std::size_t size);

  std::size_t size() const { return size_; }
  operator std::span<BigInteger>() { return {size_ > few ? more_.data() : few_.data(), size_}; }
  operator std::span<const BigInteger>() const { return {size_ > few ? more_.data() : few_.data(), size_}; }

 private:
  static constexpr std::size_t few = 2;
  std::size_t size_;
  std::array<BigInteger, few> few_;
  std::vector<BigInteger> more_;  // all of them, if they are more
};

class RootNumber {
 public:
  RootNumber(int128 value) : RootNumber(BigInteger(value)) {}
  RootNumber(const BigInteger& value) : terms_({&value, 1}) {}
  // Of 2^level coefficients: bit i of an index tells whether root i is in the product.
  RootNumber(const SqrtTower* tower, RootTerms terms) : tower_(tower), terms_(std::move(terms)) {}

  std::span<const BigInteger> coefficients() const { return terms_; }
  const SqrtTower* tower() const { return tower_; }
  int sign() const;

  RootNumber operator-() const;
  friend RootNumber operator+(RootNumber a, const RootNumber& b);
  friend RootNumber operator-(RootNumber a, const RootNumber& b);
  friend RootNumber operator*(const RootNumber& a, const RootNumber& b);

 private:
  void widen(std::size_t size);

  const SqrtTower* tower_ = nullptr;  // no matter for integers
  RootTerms terms_;
};

inline RootNumber square(const RootNumber& a) { return a * a; }

// Keep it where it is: numbers point to it.
class SqrtTower {
 public:
  SqrtTower() = default;
  SqrtTower(const SqrtTower&) = delete;
  SqrtTower& operator=(const SqrtTower&) = delete;

  // The square root of a positive number of this tower.
  RootNumber adjoin_root(const RootNumber& radicand);
  // The roots of another tower in this one, and a number of the other one, made of these.
  std::vector<RootNumber> adjoin_all(const SqrtTower& other);
  static RootNumber lift(const RootNumber& number, std::span<const RootNumber> roots);

  std::size_t depth() const { return radicands_.size(); }
  const RootNumber& radicand(std::size_t level) const { return radicands_[level]; }

 private:
  std::vector<RootNumber> radicands_;
};

// A positive number to a relative error of some 2^-60: mantissa 2^exponent, the highest bit of mantissa set.
struct RootMagnitude {
  std::uint64_t mantissa;
  std::int64_t exponent;

  double rounded() const;  // may be infinite or subnormal
};

// |number|, which must not be zero. Nothing cancels: low - high sqrt(a) is (low^2 - a high^2) / (low + high
// sqrt(a)) for positive low and high. So each operation adds at most 2^-62 to the relative error.
RootMagnitude magnitude(const RootNumber& number);
RootMagnitude operator*(const RootMagnitude& a, const RootMagnitude& b);
RootMagnitude operator/(const RootMagnitude& a, const RootMagnitude& b);
RootMagnitude operator+(const RootMagnitude& a, const RootMagnitude& b);
RootMagnitude square_root(const RootMagnitude& a);

}  // namespace vorotool::core::numbers
