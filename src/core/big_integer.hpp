// Integers of varying length for exact signs: sign and magnitude, no memory taken.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/arithmetic.hpp"

namespace vorotool::core {

class BigInteger {
 public:
  // Enough for every caller (segment_exact.cpp derives 7 264 bits); beyond it std::length_error is thrown.
  static constexpr std::size_t capacity = 116;

  BigInteger() {}  // zero; limbs beyond the size have no value
  BigInteger(std::int64_t value);
  BigInteger(const BigInteger& other) { *this = other; }
  BigInteger& operator=(const BigInteger& other);

  int sign() const { return size_ == 0 ? 0 : negative_ ? -1 : 1; }
  std::size_t bits() const;  // of the magnitude; 0 for zero
  // The 64 highest bits of the magnitude, the highest set: |value| = leading (1 + e) 2^(bits - 64) with
  // 0 <= e < 2^-63. The value must not be zero.
  std::uint64_t leading_bits() const;

  BigInteger operator-() const;
  friend BigInteger operator+(const BigInteger& a, const BigInteger& b) { return sum(a, b, b.negative_); }
  friend BigInteger operator-(const BigInteger& a, const BigInteger& b) { return sum(a, b, !b.negative_); }
  friend BigInteger operator*(const BigInteger& a, const BigInteger& b);

 private:
  // a + b or a - b: |b| with the given sign is added.
  static BigInteger sum(const BigInteger& a, const BigInteger& b, bool b_negative);
  static int compare_magnitudes(const BigInteger& a, const BigInteger& b);
  static void add_magnitudes(const BigInteger& a, const BigInteger& b, BigInteger& result);
  static void subtract_magnitudes(const BigInteger& larger, const BigInteger& smaller, BigInteger& result);
  void append(std::uint64_t limb);
  void drop_leading_zeros();

  std::size_t size_ = 0;
  bool negative_ = false;
  std::array<std::uint64_t, capacity> limb_;  // the lowest first; the last one in use is not zero
};

}  // namespace vorotool::core
