// Numbers as unevaluated sums of two doubles: about 106 bits, the range of exponents of a double.
//
// The bounds of the relative errors, with u = 2^-53, are those of Joldes, Muller and Popescu 2017 ("Tight and
// rigorous error bounds for basic building blocks of double-word arithmetic"): sum 3 u^2 + 13 u^3 (algorithm
// 6), product 7 u^2 (algorithm 10 without a fused operation), quotient 15 u^2 + 56 u^3 (algorithm 17). For
// the square root see there.
#pragma once

#include <cmath>

#include "core/numbers/expansion.hpp"
#include "core/numbers/int128.hpp"

namespace vorotool::core::numbers {

struct DoubleDouble {
  double head = 0;  // the sum rounded to a double
  double tail = 0;

  DoubleDouble() = default;
  DoubleDouble(double value) : head(value) {}
  DoubleDouble(const TwoTerms& value) : head(value.head), tail(value.tail) {}
  DoubleDouble(double head, double tail) : head(head), tail(tail) {}
  // Exact below 2^106: the remainder has at most 53 bits.
  explicit DoubleDouble(int128 value) : head(static_cast<double>(value)) {
    tail = static_cast<double>(value - static_cast<int128>(head));
  }

  explicit operator double() const { return head; }
};

// Dekker's sum, for |a| >= |b| or a == 0.
inline TwoTerms fast_two_sum(double a, double b) {
  const double head = a + b;
  return {head, b - (head - a)};
}

inline DoubleDouble operator-(const DoubleDouble& a) { return DoubleDouble(TwoTerms{-a.head, -a.tail}); }

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const TwoTerms heads = two_sum(a.head, b.head);
  const TwoTerms tails = two_sum(a.tail, b.tail);
  const TwoTerms sum = fast_two_sum(heads.head, heads.tail + tails.head);
  return DoubleDouble(fast_two_sum(sum.head, tails.tail + sum.tail));
}

inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const TwoTerms product = two_product(a.head, b.head, split(b.head));
  const double cross = a.head * b.tail + a.tail * b.head;
  return DoubleDouble(fast_two_sum(product.head, product.tail + cross));
}

inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double quotient = a.head / b.head;
  const DoubleDouble remainder = a - b * DoubleDouble(quotient);
  return DoubleDouble(fast_two_sum(quotient, remainder.head / b.head));
}

// One step of Newton from the root of the head, which has a relative error of at most 2 u: what remains is
// its square, halved, and the roundings of the step: below 8 u^2.
inline DoubleDouble sqrt(const DoubleDouble& a) {
  if (a.head <= 0) return DoubleDouble(0.0);
  const double root = std::sqrt(a.head);
  const DoubleDouble remainder = a - DoubleDouble(two_product(root, root, split(root)));
  return DoubleDouble(fast_two_sum(root, remainder.head / (2 * root)));
}

inline bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
  return a.head < b.head || (a.head == b.head && a.tail < b.tail);
}
inline bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }

inline DoubleDouble abs(const DoubleDouble& a) { return a.head < 0 ? -a : a; }

}  // namespace vorotool::core::numbers
