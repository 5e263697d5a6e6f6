// One lane, in plain C++: the portable kernel (doubles) and the wide one (128-bit integers).
#pragma once

#include <cstring>

#include "core/tessellation/row_kernel.hpp"

namespace vorotool::core::tessellation {

// floor(numerator / denominator) and whether it is exact, for doubles that hold integers of at most 2^53.
// The rounded quotient is off by less than one, and the remainder tells in which direction.
inline std::int64_t floor_divide(double numerator, double denominator, bool& exact) {
  const auto whole = static_cast<std::int64_t>(numerator / denominator);
  const auto divisor = static_cast<std::int64_t>(denominator);
  std::int64_t quotient = whole;
  std::int64_t remainder = static_cast<std::int64_t>(numerator) - quotient * divisor;
  if (remainder < 0) {
    --quotient;
    remainder += divisor;
  } else if (remainder >= divisor) {
    ++quotient;
    remainder -= divisor;
  }
  exact = remainder == 0;
  return quotient;
}

inline numbers::int128 floor_divide(numbers::int128 numerator, numbers::int128 denominator, bool& exact) {
  const numbers::int128 quotient = numerator / denominator;
  const numbers::int128 remainder = numerator % denominator;
  exact = remainder == 0;
  return remainder < 0 ? quotient - 1 : quotient;
}

template <class ArithmeticOfLane>
struct ScalarLanes {
  using Arithmetic = ArithmeticOfLane;
  using Value = typename Arithmetic::Value;
  using Coordinate = typename Arithmetic::Coordinate;
  using Mask = std::uint32_t;
  static constexpr std::int32_t width = 1;
  static constexpr int bytes = 16;

  static Value load(const Value* p) { return *p; }
  static Value above(Coordinate row, const Coordinate* y) { return static_cast<Value>(row - *y); }
  static Value below(Coordinate row, const Coordinate* y) { return static_cast<Value>(*y - row); }
  static void set_coordinates(Coordinate* y, Mask which, Coordinate v) {
    if (which) *y = v;
  }
  static Value broadcast(Coordinate v) { return static_cast<Value>(v); }
  static Value add(Value a, Value b) { return a + b; }
  static Value sub(Value a, Value b) { return a - b; }
  static Value mul(Value a, Value b) { return a * b; }
  static Value scale(Value a, std::int64_t factor) { return a * static_cast<Value>(factor); }
  static Value times(Value a, double factor) { return a * static_cast<Value>(factor); }
  static Mask less(Value a, Value b) { return a < b; }
  static Mask equal(Value a, Value b) { return a == b; }
  static Value choose(Mask second, Value a, Value b) { return second ? b : a; }
  static void compress(Value* out, Mask keep, Value v) {
    if (keep) *out = v;
  }

  static void store_index(std::uint32_t* out, std::uint32_t v) { *out = v; }
  static std::uint32_t load_index(const std::uint32_t* p) { return *p; }
  static std::uint32_t choose_index(Mask second, std::uint32_t a, std::uint32_t b) { return second ? b : a; }
  static std::uint32_t min_index(std::uint32_t a, std::uint32_t b) { return a < b ? a : b; }
  static std::uint32_t count_from(std::int32_t first) { return static_cast<std::uint32_t>(first); }
  static void compress_index(std::uint32_t* out, Mask keep, std::uint32_t v) {
    if (keep) *out = v;
  }

  static Mask divide(Value rise, Value run, Mask, const PixelRow& pixels, std::int32_t* end) {
    bool exact = false;
    const auto quotient = floor_divide(rise, run, exact) + pixels.middle;
    const std::int32_t last = pixels.width - 1;
    *end = quotient < -1 ? -1 : quotient > last ? last : static_cast<std::int32_t>(quotient);
    return exact && quotient >= 0 && quotient <= last;
  }

  // For rounded values: the boundary where the error of the quotient cannot change it, else doubt.
  static Mask bracket(Value rise, Value run, Value error, const PixelRow& pixels, std::int32_t* end) {
    const auto pixel = [&](Value at) {
      const Value p = __builtin_floor(at) + pixels.middle;
      return static_cast<std::int32_t>(p < -1 ? -1 : p > pixels.width - 1 ? pixels.width - 1 : p);
    };
    const Value quotient = rise / run;
    *end = pixel(quotient - error / run);
    return *end != pixel(quotient + error / run);
  }

  static void stream(void* target, const void* source, std::size_t bytes) {
    std::memcpy(target, source, bytes);
  }
  static void fence() {}
};

}  // namespace vorotool::core::tessellation
