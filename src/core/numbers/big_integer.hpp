// Integers of any length for exact signs: sign and magnitude. Short ones take no memory.
//
// For the sign of a b - c d these take 34 ns at 64 bits, 162 at 512 and 502 at 1024, Boost's cpp_int 45,
// 187 and 551, GMP 69, 132 and 363 (tests/benchmarks/core_parts.cpp): most numbers of exact signs are
// short, and where they are not GMP would not pay for a library to link and to ship.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "core/numbers/int128.hpp"

namespace vorotool::core::numbers {

class BigInteger {
 public:
  // Integers of up to 1 152 bits lie in the object itself, longer ones elsewhere (sizes:
  // core/segment_voronoi/discs/exact_signs.cpp).
  static constexpr std::size_t short_limbs = 18;

  BigInteger() {}  // zero; limbs beyond the size have no value
  BigInteger(int128 value);
  BigInteger(const BigInteger& other) { *this = other; }
  BigInteger(BigInteger&& other) noexcept { *this = std::move(other); }
  BigInteger& operator=(const BigInteger& other);
  BigInteger& operator=(BigInteger&& other) noexcept;

  int sign() const { return size_ == 0 ? 0 : negative_ ? -1 : 1; }
  std::size_t bits() const;  // of the magnitude; 0 for zero
  // The 64 highest bits of the magnitude, the highest set: |value| = leading (1 + e) 2^(bits - 64) with
  // 0 <= e < 2^-63. The value must not be zero.
  std::uint64_t leading_bits() const;
  // To a relative error of 2^-53; below 2^1023.
  double rounded() const;

  void negate() { negative_ = !negative_; }
  BigInteger& operator+=(const BigInteger& other) { return add(other, other.negative_); }
  BigInteger& operator-=(const BigInteger& other) { return add(other, !other.negative_); }
  friend BigInteger operator*(const BigInteger& a, const BigInteger& b);
  friend BigInteger operator<<(const BigInteger& a, int bits);
  // -1, 0 or 1 as a is less than, equal to or greater than b.
  friend int compare(const BigInteger& a, const BigInteger& b);
  friend bool operator==(const BigInteger& a, const BigInteger& b) { return compare(a, b) == 0; }

  // The root of a positive square of at most 254 bits; nothing for any other integer.
  friend std::optional<BigInteger> integer_root(const BigInteger& a);

 private:
  const std::uint64_t* limbs() const { return long_ ? long_.get() : short_.data(); }
  std::uint64_t* limbs() { return long_ ? long_.get() : short_.data(); }
  void reserve(std::size_t limbs);
  BigInteger& add(const BigInteger& other, bool other_negative);
  void add_magnitude(const BigInteger& other);
  static int compare_magnitudes(const BigInteger& a, const BigInteger& b);
  // |*this| = |larger| - |smaller|, of which *this may be one.
  void take_difference(const BigInteger& larger, const BigInteger& smaller);
  void drop_leading_zeros();

  std::size_t size_ = 0;
  std::size_t capacity_ = short_limbs;
  bool negative_ = false;
  std::array<std::uint64_t, short_limbs> short_;  // the lowest first; the last one in use is not zero
  std::unique_ptr<std::uint64_t[]> long_;         // instead, once more are needed
};

inline BigInteger operator-(BigInteger a) {
  a.negate();
  return a;
}
inline BigInteger operator+(BigInteger a, const BigInteger& b) { return std::move(a += b); }
inline BigInteger operator-(BigInteger a, const BigInteger& b) { return std::move(a -= b); }

}  // namespace vorotool::core::numbers
