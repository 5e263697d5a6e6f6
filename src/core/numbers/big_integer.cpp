#include "core/numbers/big_integer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/numbers/double_double.hpp"

namespace vorotool::core::numbers {

BigInteger::BigInteger(int128 value) : size_(2), negative_(value < 0) {
  const auto bits = static_cast<uint128>(value);
  const uint128 magnitude = negative_ ? 0 - bits : bits;
  short_[0] = static_cast<std::uint64_t>(magnitude);
  short_[1] = static_cast<std::uint64_t>(magnitude >> 64);
  drop_leading_zeros();
}

BigInteger& BigInteger::operator=(const BigInteger& other) {
  if (this == &other) return *this;
  size_ = 0;
  reserve(other.size_);
  size_ = other.size_;
  negative_ = other.negative_;
  std::copy_n(other.limbs(), size_, limbs());
  return *this;
}

BigInteger& BigInteger::operator=(BigInteger&& other) noexcept {
  if (!other.long_) return *this = std::as_const(other);
  std::swap(long_, other.long_);
  std::swap(capacity_, other.capacity_);
  size_ = std::exchange(other.size_, 0);
  negative_ = other.negative_;
  return *this;
}

void BigInteger::reserve(std::size_t wanted) {
  if (wanted <= capacity_) return;
  auto longer = std::make_unique_for_overwrite<std::uint64_t[]>(wanted);
  std::copy_n(limbs(), size_, longer.get());
  long_ = std::move(longer);
  capacity_ = wanted;
}

void BigInteger::drop_leading_zeros() {
  const std::uint64_t* limb = limbs();
  while (size_ > 0 && limb[size_ - 1] == 0) --size_;
}

std::size_t BigInteger::bits() const {
  return size_ == 0 ? 0 : 64 * size_ - static_cast<std::size_t>(std::countl_zero(limbs()[size_ - 1]));
}

std::uint64_t BigInteger::leading_bits() const {
  const std::uint64_t* last = limbs() + size_ - 1;
  const int shift = std::countl_zero(*last);
  if (shift == 0 || size_ == 1) return *last << shift;
  return *last << shift | last[-1] >> (64 - shift);
}

double BigInteger::rounded() const {
  if (size_ == 0) return 0;
  const double magnitude = std::ldexp(static_cast<double>(leading_bits()), static_cast<int>(bits()) - 64);
  return negative_ ? -magnitude : magnitude;
}

int BigInteger::compare_magnitudes(const BigInteger& a, const BigInteger& b) {
  if (a.size_ != b.size_) return a.size_ < b.size_ ? -1 : 1;
  const std::uint64_t *p = a.limbs(), *q = b.limbs();
  for (std::size_t i = a.size_; i-- > 0;) {
    if (p[i] != q[i]) return p[i] < q[i] ? -1 : 1;
  }
  return 0;
}

BigInteger& BigInteger::add(const BigInteger& other, bool other_negative) {
  if (other.size_ == 0) return *this;
  if (size_ == 0) negative_ = other_negative;
  if (negative_ == other_negative) {
    add_magnitude(other);
  } else if (compare_magnitudes(*this, other) >= 0) {
    take_difference(*this, other);
  } else {
    take_difference(other, *this);
    negative_ = other_negative;
  }
  return *this;
}

void BigInteger::add_magnitude(const BigInteger& other) {
  const std::size_t longest = std::max(size_, other.size_), added = other.size_;
  reserve(longest + 1);
  std::uint64_t* limb = limbs();
  std::fill(limb + size_, limb + longest, 0);
  const std::uint64_t* from = other.limbs();
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < longest && (i < added || carry != 0); ++i) {
    const uint128 sum = uint128{limb[i]} + (i < added ? from[i] : 0) + carry;
    limb[i] = static_cast<std::uint64_t>(sum);
    carry = static_cast<std::uint64_t>(sum >> 64);
  }
  size_ = longest;
  if (carry != 0) limb[size_++] = carry;
}

void BigInteger::take_difference(const BigInteger& larger, const BigInteger& smaller) {
  const std::size_t size = larger.size_, taken = smaller.size_;
  reserve(size);
  const std::uint64_t *p = larger.limbs(), *q = smaller.limbs();
  std::uint64_t* limb = limbs();
  std::uint64_t borrow = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const uint128 difference = uint128{p[i]} - (i < taken ? q[i] : 0) - borrow;
    limb[i] = static_cast<std::uint64_t>(difference);
    borrow = static_cast<std::uint64_t>(difference >> 64) & 1;
  }
  size_ = size;
  drop_leading_zeros();
}

BigInteger operator*(const BigInteger& a, const BigInteger& b) {
  BigInteger product;
  if (a.size_ == 0 || b.size_ == 0) return product;
  product.reserve(a.size_ + b.size_);
  product.negative_ = a.negative_ != b.negative_;
  product.size_ = a.size_ + b.size_;
  const std::uint64_t *p = a.limbs(), *q = b.limbs();
  std::uint64_t* limb = product.limbs();
  std::fill_n(limb, b.size_, 0);
  for (std::size_t i = 0; i < a.size_; ++i) {
    std::uint64_t carry = 0;  // (2^64 - 1)^2 + 2 (2^64 - 1) = 2^128 - 1: the sum below fits
    for (std::size_t j = 0; j < b.size_; ++j) {
      const uint128 next = uint128{p[i]} * q[j] + limb[i + j] + carry;
      limb[i + j] = static_cast<std::uint64_t>(next);
      carry = static_cast<std::uint64_t>(next >> 64);
    }
    limb[i + b.size_] = carry;
  }
  product.drop_leading_zeros();
  return product;
}

BigInteger operator<<(const BigInteger& a, int bits) {
  BigInteger shifted;
  if (a.size_ == 0) return shifted;
  const auto whole = static_cast<std::size_t>(bits / 64);
  const int rest = bits % 64;
  shifted.reserve(a.size_ + whole + 1);
  shifted.negative_ = a.negative_;
  shifted.size_ = a.size_ + whole + 1;
  const std::uint64_t* from = a.limbs();
  std::uint64_t* limb = shifted.limbs();
  std::fill_n(limb, shifted.size_, 0);
  for (std::size_t i = 0; i < a.size_; ++i) {
    const uint128 spread = uint128{from[i]} << rest;
    limb[i + whole] |= static_cast<std::uint64_t>(spread);
    limb[i + whole + 1] = static_cast<std::uint64_t>(spread >> 64);
  }
  shifted.drop_leading_zeros();
  return shifted;
}

int compare(const BigInteger& a, const BigInteger& b) {
  const int left = a.sign(), right = b.sign();
  if (left != right) return left < right ? -1 : 1;
  return left * BigInteger::compare_magnitudes(a, b);
}

// An approximation of 106 bits errs by less than 2^24 in a root of 127. The remainder a - root^2 is twice the
// root times the error, nearly: so the error is known to less than 1/2, and the square tells whether a is
// one.
std::optional<BigInteger> integer_root(const BigInteger& a) {
  constexpr std::uint64_t squares = 0x0202021202030213;  // modulo 64
  if (a.sign() <= 0 || a.bits() > 254 || (squares >> (a.limbs()[0] % 64) & 1) == 0) return std::nullopt;
  DoubleDouble value;
  for (std::size_t i = a.size_; i-- > 0;) {
    value = value * DoubleDouble(0x1p64) + DoubleDouble(static_cast<int128>(a.limbs()[i]));
  }
  const DoubleDouble near = sqrt(value);
  BigInteger root(static_cast<int128>(near.head) + static_cast<int128>(near.tail));
  const BigInteger rest = a - root * root;
  if (rest.sign() == 0) return root;
  root += BigInteger(static_cast<int128>(std::nearbyint(rest.rounded() / (2 * root.rounded()))));
  if (root * root == a) return root;
  return std::nullopt;
}

}  // namespace vorotool::core::numbers
