// Expansions: exact numbers as unevaluated sums of doubles (after Dekker 1971 and Shewchuk 1997).
//
// Exactness rests on two identities alone, a + b = fl(a + b) + error and a b = fl(a b) + error with the
// errors representable; they hold in any order of terms where nothing overflows and all terms of a sum or
// product are multiples of some power of two not below 2^-1074. That terms do not overlap is never assumed:
// sign() checks that the last one outweighs the others.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/numbers/sign.hpp"

namespace vorotool::core::numbers {

// head + tail is the exact value, head the rounded one.
struct TwoTerms {
  double head, tail;
};

// Knuth's sum: no order of magnitudes required.
inline TwoTerms two_sum(double a, double b) {
  const double head = a + b;
  const double b_part = head - a;
  const double a_part = head - b_part;
  return {head, (a - a_part) + (b - b_part)};
}

inline TwoTerms two_difference(double a, double b) { return two_sum(a, -b); }

// Veltkamp's split into halves of at most 26 bits, so that products of halves are exact. std::fma would need
// no split, but is a library call on processors that may lack it. |a| must be below 2^996.
inline TwoTerms split(double a) {
  const double scaled = 0x8000001p0 * a;  // 2^27 + 1
  const double head = scaled - (scaled - a);
  return {head, a - head};
}

// Dekker's product, with one factor split already.
inline TwoTerms two_product(double a, double b, const TwoTerms& b_halves) {
  const double head = a * b;
  const TwoTerms a_halves = split(a);
  const double error = ((head - a_halves.head * b_halves.head) - a_halves.tail * b_halves.head) -
                       a_halves.head * b_halves.tail;
  return {head, a_halves.tail * b_halves.tail - error};
}

// A sum of at most `capacity` non-zero terms; about increasing in magnitude, which only makes it short.
template <int capacity>
struct Expansion {
  std::array<double, capacity> term;
  int size = 0;

  Expansion() {}  // the terms beyond size have no value
  explicit Expansion(const TwoTerms& value) {
    append(value.tail);
    append(value.head);
  }

  std::span<const double> terms() const { return std::span(term).first(static_cast<std::size_t>(size)); }
  void append(double value) {
    if (value != 0) term[static_cast<std::size_t>(size++)] = value;
  }

  // The sign, or `undecided` if the last term does not outweigh the others together. Their sum of up to n
  // terms is at most fl(sum) (1 - u)^-n, and (1 - 2^-53)^-4096 < 1 + 2^-40.
  int sign() const {
    static_assert(capacity <= 4096);
    if (size == 0) return 0;
    double others = 0;
    for (int i = 0; i + 1 < size; ++i) others += std::abs(term[static_cast<std::size_t>(i)]);
    const double last = term[static_cast<std::size_t>(size - 1)];
    return std::abs(last) > others * (1 + 0x1p-39) ? sign_of(last) : undecided;
  }
};

// result = e + f: the terms of both by increasing magnitude, each added to the sum so far; the errors are
// kept.
template <int capacity>
void add(std::span<const double> e, std::span<const double> f, Expansion<capacity>& result) {
  result.size = 0;
  std::size_t i = 0, j = 0;
  double sum = 0;
  while (i < e.size() || j < f.size()) {
    const bool take_e = j == f.size() || (i < e.size() && std::abs(e[i]) < std::abs(f[j]));
    const TwoTerms next = two_sum(sum, take_e ? e[i++] : f[j++]);
    result.append(next.tail);
    sum = next.head;
  }
  result.append(sum);
}

template <int m, int n>
Expansion<m + n> operator+(const Expansion<m>& e, const Expansion<n>& f) {
  Expansion<m + n> result;
  add(e.terms(), f.terms(), result);
  return result;
}

template <int n>
Expansion<n> operator-(Expansion<n> e) {
  for (int i = 0; i < e.size; ++i) e.term[static_cast<std::size_t>(i)] *= -1;
  return e;
}

template <int m, int n>
Expansion<m + n> operator-(const Expansion<m>& e, const Expansion<n>& f) {
  return e + -f;
}

template <int n>
Expansion<2 * n> operator*(const Expansion<n>& e, double factor) {
  Expansion<2 * n> result;
  const TwoTerms halves = split(factor);
  double sum = 0;
  for (const double term : e.terms()) {
    const TwoTerms product = two_product(term, factor, halves);
    const TwoTerms low = two_sum(sum, product.tail);
    const TwoTerms high = two_sum(product.head, low.head);
    result.append(low.tail);
    result.append(high.tail);
    sum = high.head;
  }
  result.append(sum);
  return result;
}

template <int m, int n>
Expansion<2 * m * n> operator*(const Expansion<m>& e, const Expansion<n>& f) {
  Expansion<2 * m * n> sum, next;
  for (const double factor : f.terms()) {
    add(sum.terms(), (e * factor).terms(), next);
    std::swap(sum, next);
  }
  return sum;
}

}  // namespace vorotool::core::numbers
