// Doubles as integers: any set of finite ones lies on a lattice of step 2^exponent.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/numbers/fixed_integer.hpp"
#include "core/numbers/int128.hpp"

namespace vorotool::core::numbers {

// A double as mantissa 2^exponent, the mantissa odd or, for zero, zero.
struct OddMantissa {
  explicit OddMantissa(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const int biased = static_cast<int>(bits >> 52 & 0x7ff);  // 0 for zero and subnormals
    is_negative = bits >> 63 != 0;
    mantissa = (bits & 0xfffffffffffff) | (biased == 0 ? 0 : std::uint64_t{1} << 52);
    if (mantissa == 0) return;
    const int zeros = std::countr_zero(mantissa);
    mantissa >>= zeros;
    exponent = std::max(biased, 1) - 1075 + zeros;
  }

  int width() const { return static_cast<int>(std::bit_width(mantissa)); }

  std::uint64_t mantissa;
  int exponent = 0;
  bool is_negative;
};

// The coarsest lattice that holds the values: they are integers below 2^bits in magnitude, times 2^exponent.
// bits <= 2098, since the bits of finite doubles are worth 2^-1074 to 2^1023.
struct DyadicGrid {
  int exponent = 1024, bits = 0;

  template <std::size_t n>
  explicit DyadicGrid(const std::array<double, n>& values) {
    int above = -1074;
    for (const double value : values) {
      const OddMantissa parts(value);
      if (parts.mantissa == 0) continue;
      exponent = std::min(exponent, parts.exponent);
      above = std::max(above, parts.exponent + parts.width());
    }
    bits = std::max(above - exponent, 0);
  }

  // The integer of a value, where bits <= 63.
  std::int64_t integer(double value) const {
    const OddMantissa parts(value);
    if (parts.mantissa == 0) return 0;
    const auto magnitude = static_cast<std::int64_t>(parts.mantissa << (parts.exponent - exponent));
    return parts.is_negative ? -magnitude : magnitude;
  }

  // The same, where bits < 64 limbs.
  template <std::size_t limbs>
  FixedInteger<limbs> fixed_integer(double value) const {
    const OddMantissa parts(value);
    FixedInteger<limbs> result;
    if (parts.mantissa == 0) return result;
    const auto shift = static_cast<std::size_t>(parts.exponent - exponent);
    const std::size_t first = shift / 64;
    const uint128 spread = uint128{parts.mantissa} << shift % 64;
    result.limb[first] = static_cast<std::uint64_t>(spread);
    if (first + 1 < limbs) result.limb[first + 1] = static_cast<std::uint64_t>(spread >> 64);
    return parts.is_negative ? FixedInteger<limbs>{} - result : result;
  }
};

}  // namespace vorotool::core::numbers
