// Integers of any size, for decisions that floating point leaves open: exact, and rare.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace vorotool::core {

class Natural {
 public:
  Natural(std::uint64_t value = 0) {
    if (value != 0) limbs_.push_back(value);
  }

  bool is_zero() const { return limbs_.empty(); }
  // Number of bits without leading zeros.
  int width() const;
  // The 64 bits from the highest one on, as an integer times 2^(width() - 64).
  std::uint64_t leading() const;

  // -1, 0 or 1 as a is less than, equal to or greater than b.
  friend int compare(const Natural& a, const Natural& b);
  friend Natural operator+(const Natural& a, const Natural& b);
  // a must not be less than b.
  friend Natural operator-(const Natural& a, const Natural& b);
  friend Natural operator*(const Natural& a, const Natural& b);
  friend Natural operator<<(const Natural& a, int bits);

 private:
  void trim() {
    while (!limbs_.empty() && limbs_.back() == 0) limbs_.pop_back();
  }

  std::vector<std::uint64_t> limbs_;  // the lowest first, the highest not zero
};

// A natural number with a sign.
struct Integer {
  Natural magnitude;
  bool is_negative = false;

  int sign() const { return magnitude.is_zero() ? 0 : is_negative ? -1 : 1; }
};

Integer operator-(const Integer& a, const Integer& b);
inline Integer operator-(Integer a) { return {std::move(a.magnitude), !a.is_negative}; }
inline Integer operator+(const Integer& a, const Integer& b) { return a - -b; }
inline Integer operator*(const Integer& a, const Integer& b) {
  return {a.magnitude * b.magnitude, a.is_negative != b.is_negative};
}

}  // namespace vorotool::core
