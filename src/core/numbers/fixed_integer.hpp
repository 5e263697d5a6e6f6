// Integers of any fixed number of 64-bit limbs, in two's complement. Nothing checks for overflow: the
// caller derives how many limbs are enough. Boost's cpp_int of fixed width takes 322 ns for an incircle of
// 2 limbs and 2194 ns for one of 8, these take 238 and 2001 (tests/benchmarks/core_parts.cpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/numbers/int128.hpp"

namespace vorotool::core::numbers {

template <std::size_t limbs>
struct FixedInteger {
  std::array<std::uint64_t, limbs> limb{};  // the lowest first

  bool is_negative() const { return limb[limbs - 1] >> 63 != 0; }

  int sign() const {
    if (is_negative()) return -1;
    for (const std::uint64_t value : limb) {
      if (value != 0) return 1;
    }
    return 0;
  }
};

template <std::size_t n>
FixedInteger<n> operator+(const FixedInteger<n>& a, const FixedInteger<n>& b) {
  FixedInteger<n> sum;
  uint128 carry = 0;
  for (std::size_t i = 0; i < n; ++i) {
    carry += uint128{a.limb[i]} + b.limb[i];
    sum.limb[i] = static_cast<std::uint64_t>(carry);
    carry >>= 64;
  }
  return sum;
}

// Subtracts b from the limbs of a at `first` and above; a borrow beyond the last limb is dropped.
template <std::size_t n, std::size_t m>
void subtract_at(FixedInteger<n>& a, const FixedInteger<m>& b, std::size_t first) {
  std::uint64_t borrow = 0;
  for (std::size_t i = 0; i < m && first + i < n; ++i) {
    const uint128 difference = uint128{a.limb[first + i]} - b.limb[i] - borrow;
    a.limb[first + i] = static_cast<std::uint64_t>(difference);
    borrow = static_cast<std::uint64_t>(difference >> 64) & 1;
  }
}

template <std::size_t n>
FixedInteger<n> operator-(FixedInteger<n> a, const FixedInteger<n>& b) {
  subtract_at(a, b, 0);
  return a;
}

// The limbs are multiplied as if unsigned. A negative a counts as a + 2^(64 n) then, so 2^(64 n) b is taken
// off again, and likewise for b.
template <std::size_t n, std::size_t m>
FixedInteger<n + m> operator*(const FixedInteger<n>& a, const FixedInteger<m>& b) {
  FixedInteger<n + m> product;
  for (std::size_t i = 0; i < n; ++i) {
    std::uint64_t carry = 0;  // (2^64 - 1)^2 + 2 (2^64 - 1) = 2^128 - 1: the sum below fits
    for (std::size_t j = 0; j < m; ++j) {
      const uint128 sum = uint128{a.limb[i]} * b.limb[j] + product.limb[i + j] + carry;
      product.limb[i + j] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64);
    }
    product.limb[i + m] = carry;
  }
  if (a.is_negative()) subtract_at(product, b, n);
  if (b.is_negative()) subtract_at(product, a, m);
  return product;
}

inline FixedInteger<2> widen(int128 value) {
  const auto bits = static_cast<uint128>(value);
  return {{static_cast<std::uint64_t>(bits), static_cast<std::uint64_t>(bits >> 64)}};
}

}  // namespace vorotool::core::numbers
