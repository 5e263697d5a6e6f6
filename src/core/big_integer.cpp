#include "core/big_integer.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace vorotool::core {

BigInteger::BigInteger(std::int64_t value) : negative_(value < 0) {
  const auto bits = static_cast<std::uint64_t>(value);
  if (value != 0) append(negative_ ? 0 - bits : bits);
}

BigInteger& BigInteger::operator=(const BigInteger& other) {
  size_ = other.size_;
  negative_ = other.negative_;
  std::copy_n(other.limb_.begin(), size_, limb_.begin());
  return *this;
}

void BigInteger::append(std::uint64_t limb) {
  if (size_ == capacity) throw std::length_error("a BigInteger needs more limbs than were derived");
  limb_[size_++] = limb;
}

void BigInteger::drop_leading_zeros() {
  while (size_ > 0 && limb_[size_ - 1] == 0) --size_;
}

std::size_t BigInteger::bits() const {
  return size_ == 0 ? 0 : 64 * size_ - static_cast<std::size_t>(std::countl_zero(limb_[size_ - 1]));
}

std::uint64_t BigInteger::leading_bits() const {
  const int shift = std::countl_zero(limb_[size_ - 1]);
  if (shift == 0 || size_ == 1) return limb_[size_ - 1] << shift;
  return limb_[size_ - 1] << shift | limb_[size_ - 2] >> (64 - shift);
}

BigInteger BigInteger::operator-() const {
  BigInteger result = *this;
  result.negative_ = !negative_;
  return result;
}

int BigInteger::compare_magnitudes(const BigInteger& a, const BigInteger& b) {
  if (a.size_ != b.size_) return a.size_ < b.size_ ? -1 : 1;
  for (std::size_t i = a.size_; i-- > 0;) {
    if (a.limb_[i] != b.limb_[i]) return a.limb_[i] < b.limb_[i] ? -1 : 1;
  }
  return 0;
}

void BigInteger::add_magnitudes(const BigInteger& a, const BigInteger& b, BigInteger& result) {
  const BigInteger& longer = a.size_ < b.size_ ? b : a;
  const BigInteger& shorter = a.size_ < b.size_ ? a : b;
  uint128 carry = 0;
  for (std::size_t i = 0; i < longer.size_; ++i) {
    carry += uint128{longer.limb_[i]} + (i < shorter.size_ ? shorter.limb_[i] : 0);
    result.limb_[i] = static_cast<std::uint64_t>(carry);
    carry >>= 64;
  }
  result.size_ = longer.size_;
  if (carry != 0) result.append(static_cast<std::uint64_t>(carry));
}

void BigInteger::subtract_magnitudes(const BigInteger& larger, const BigInteger& smaller,
                                     BigInteger& result) {
  std::uint64_t borrow = 0;
  for (std::size_t i = 0; i < larger.size_; ++i) {
    const uint128 difference = uint128{larger.limb_[i]} - (i < smaller.size_ ? smaller.limb_[i] : 0) - borrow;
    result.limb_[i] = static_cast<std::uint64_t>(difference);
    borrow = static_cast<std::uint64_t>(difference >> 64) & 1;
  }
  result.size_ = larger.size_;
  result.drop_leading_zeros();
}

BigInteger BigInteger::sum(const BigInteger& a, const BigInteger& b, bool b_negative) {
  BigInteger result;
  if (a.negative_ == b_negative) {
    result.negative_ = b_negative;
    add_magnitudes(a, b, result);
  } else if (compare_magnitudes(a, b) >= 0) {
    result.negative_ = a.negative_;
    subtract_magnitudes(a, b, result);
  } else {
    result.negative_ = b_negative;
    subtract_magnitudes(b, a, result);
  }
  return result;
}

BigInteger operator*(const BigInteger& a, const BigInteger& b) {
  BigInteger product;
  if (a.size_ == 0 || b.size_ == 0) return product;
  if (a.size_ + b.size_ > BigInteger::capacity) {
    throw std::length_error("a product of BigIntegers needs more limbs than were derived");
  }
  product.negative_ = a.negative_ != b.negative_;
  product.size_ = a.size_ + b.size_;
  std::fill_n(product.limb_.begin(), product.size_, 0);
  for (std::size_t i = 0; i < a.size_; ++i) {
    std::uint64_t carry = 0;  // (2^64 - 1)^2 + 2 (2^64 - 1) = 2^128 - 1: the sum below fits
    for (std::size_t j = 0; j < b.size_; ++j) {
      const uint128 next = uint128{a.limb_[i]} * b.limb_[j] + product.limb_[i + j] + carry;
      product.limb_[i + j] = static_cast<std::uint64_t>(next);
      carry = static_cast<std::uint64_t>(next >> 64);
    }
    product.limb_[i + b.size_] = carry;
  }
  product.drop_leading_zeros();
  return product;
}

}  // namespace vorotool::core
