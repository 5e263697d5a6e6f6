#include "core/natural.hpp"

#include <algorithm>
#include <bit>

#include "core/arithmetic.hpp"

namespace vorotool::core {

int Natural::width() const {
  if (is_zero()) return 0;
  return static_cast<int>(64 * (limbs_.size() - 1)) + static_cast<int>(std::bit_width(limbs_.back()));
}

std::uint64_t Natural::leading() const {
  if (is_zero()) return 0;
  const int zeros = std::countl_zero(limbs_.back());
  const std::uint64_t high = limbs_.back() << zeros;
  return zeros == 0 || limbs_.size() == 1 ? high : high | limbs_[limbs_.size() - 2] >> (64 - zeros);
}

int compare(const Natural& a, const Natural& b) {
  if (a.limbs_.size() != b.limbs_.size()) return a.limbs_.size() < b.limbs_.size() ? -1 : 1;
  for (std::size_t i = a.limbs_.size(); i-- > 0;) {
    if (a.limbs_[i] != b.limbs_[i]) return a.limbs_[i] < b.limbs_[i] ? -1 : 1;
  }
  return 0;
}

Natural operator+(const Natural& a, const Natural& b) {
  if (a.limbs_.size() < b.limbs_.size()) return b + a;
  Natural sum = a;
  sum.limbs_.push_back(0);
  uint128 carry = 0;
  for (std::size_t i = 0; i < sum.limbs_.size(); ++i) {
    carry += uint128{sum.limbs_[i]} + (i < b.limbs_.size() ? b.limbs_[i] : 0);
    sum.limbs_[i] = static_cast<std::uint64_t>(carry);
    carry >>= 64;
  }
  sum.trim();
  return sum;
}

Natural operator-(const Natural& a, const Natural& b) {
  Natural difference = a;
  std::uint64_t borrow = 0;
  for (std::size_t i = 0; i < a.limbs_.size(); ++i) {
    const uint128 value = uint128{a.limbs_[i]} - (i < b.limbs_.size() ? b.limbs_[i] : 0) - borrow;
    difference.limbs_[i] = static_cast<std::uint64_t>(value);
    borrow = static_cast<std::uint64_t>(value >> 64) & 1;
  }
  difference.trim();
  return difference;
}

Natural operator*(const Natural& a, const Natural& b) {
  Natural product;
  product.limbs_.resize(a.limbs_.size() + b.limbs_.size());
  for (std::size_t i = 0; i < a.limbs_.size(); ++i) {
    std::uint64_t carry = 0;  // (2^64 - 1)^2 + 2 (2^64 - 1) = 2^128 - 1: the sum below fits
    for (std::size_t j = 0; j < b.limbs_.size(); ++j) {
      const uint128 sum = uint128{a.limbs_[i]} * b.limbs_[j] + product.limbs_[i + j] + carry;
      product.limbs_[i + j] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64);
    }
    product.limbs_[i + b.limbs_.size()] = carry;
  }
  product.trim();
  return product;
}

Natural operator<<(const Natural& a, int bits) {
  Natural shifted;
  if (a.is_zero()) return shifted;
  const auto whole = static_cast<std::size_t>(bits / 64);
  const int rest = bits % 64;
  shifted.limbs_.resize(a.limbs_.size() + whole + 1);
  for (std::size_t i = 0; i < a.limbs_.size(); ++i) {
    const uint128 spread = uint128{a.limbs_[i]} << rest;
    shifted.limbs_[i + whole] |= static_cast<std::uint64_t>(spread);
    shifted.limbs_[i + whole + 1] = static_cast<std::uint64_t>(spread >> 64);
  }
  shifted.trim();
  return shifted;
}

Integer operator-(const Integer& a, const Integer& b) {
  if (a.is_negative != b.is_negative) return {a.magnitude + b.magnitude, a.is_negative};
  if (compare(a.magnitude, b.magnitude) >= 0) return {a.magnitude - b.magnitude, a.is_negative};
  return {b.magnitude - a.magnitude, !a.is_negative};
}

}  // namespace vorotool::core
