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
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/big_integer.hpp"

namespace vorotool::core {

class RootTower;

class RootNumber {
 public:
  RootNumber(std::int64_t value) : RootNumber(BigInteger(value)) {}
  RootNumber(const BigInteger& value) : coefficients_{value} {}
  // The size of coefficients is 2^level: bit i of an index tells whether root i is in the product.
  RootNumber(const RootTower* tower, std::vector<BigInteger> coefficients)
      : tower_(tower), coefficients_(std::move(coefficients)) {}

  std::span<const BigInteger> coefficients() const { return coefficients_; }
  const RootTower* tower() const { return tower_; }
  int sign() const;

  RootNumber operator-() const;
  friend RootNumber operator+(const RootNumber& a, const RootNumber& b);
  friend RootNumber operator-(const RootNumber& a, const RootNumber& b);
  friend RootNumber operator*(const RootNumber& a, const RootNumber& b);

 private:
  const RootTower* tower_ = nullptr;  // no matter for integers
  std::vector<BigInteger> coefficients_;
};

inline RootNumber square(const RootNumber& a) { return a * a; }

// Keep it where it is: numbers point to it.
class RootTower {
 public:
  RootTower() = default;
  RootTower(const RootTower&) = delete;
  RootTower& operator=(const RootTower&) = delete;

  // The square root of a positive number of this tower.
  RootNumber adjoin_root(const RootNumber& radicand);
  // The number of another tower in this one; `first` is what adjoin_all of that tower has given.
  RootNumber lift(const RootNumber& number, std::size_t first) const;
  std::size_t adjoin_all(const RootTower& other);

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

}  // namespace vorotool::core
