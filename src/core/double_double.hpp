// Numbers of about 106 bits: the unevaluated sum of two doubles, the head the rounded sum.
//
// With u = 2^-53, and where nothing overflows or underflows, the relative errors are below 4 u^2 for a sum of
// any signs, 8 u^2 for a product and 16 u^2 for a quotient (M. Joldes, J.-M. Muller and V. Popescu, "Tight
// and rigorous error bounds for basic building blocks of double-word arithmetic", ACM TOMS 44, 2017: 3 u^2 +
// 13 u^3 for algorithm 6, 7 u^2 for algorithm 10, 15 u^2 + 56 u^3 for algorithm 16).
#pragma once

#include "core/expansion.hpp"

namespace vorotool::core {

using DoubleDouble = TwoTerms;

// Dekker's sum: |a| >= |b|, or a = 0.
inline TwoTerms ordered_sum(double a, double b) {
  const double head = a + b;
  return {head, b - (head - a)};
}

inline TwoTerms exact_product(double a, double b) { return two_product(a, b, split(b)); }

inline DoubleDouble operator-(const DoubleDouble& x) { return {-x.head, -x.tail}; }

inline DoubleDouble operator+(const DoubleDouble& x, const DoubleDouble& y) {
  const TwoTerms heads = two_sum(x.head, y.head);
  const TwoTerms tails = two_sum(x.tail, y.tail);
  const TwoTerms sum = ordered_sum(heads.head, heads.tail + tails.head);
  return ordered_sum(sum.head, tails.tail + sum.tail);
}

inline DoubleDouble operator-(const DoubleDouble& x, const DoubleDouble& y) { return x + -y; }

inline DoubleDouble operator*(const DoubleDouble& x, const DoubleDouble& y) {
  const TwoTerms product = exact_product(x.head, y.head);
  return ordered_sum(product.head, product.tail + (x.head * y.tail + x.tail * y.head));
}

inline DoubleDouble operator/(const DoubleDouble& x, const DoubleDouble& y) {
  const double quotient = x.head / y.head;
  const TwoTerms product = exact_product(quotient, y.head);
  const TwoTerms back = ordered_sum(product.head, product.tail + quotient * y.tail);
  const double rest = (x.head - back.head) + (x.tail - back.tail);
  return ordered_sum(quotient, rest / y.head);
}

}  // namespace vorotool::core
