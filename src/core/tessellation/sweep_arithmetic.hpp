// The number systems of the row sweep, with the bound that makes each of them exact.
//
// Coordinates are integers on a lattice, relative to the middle of the frame. Let N bound their absolute values, rows
// and pixels of the frame and the sides of a pixel included. The sweep computes
//   F = x^2 + dy^2                       |x| <= N, 0 <= dy <= 2N      F <= 5 N^2
//   p = (F_b - F_i) (x_i - x_a)          differences <= 5 N^2 and 2N  |p| <= 10 N^3
//   q = (F_j - F_i) / (2 s (x_j - x_i))  s <= N along x               denominator <= 4 s N
//
// Narrow: F is a double. 5 N^2 <= 2^53 holds for N <= 2^25, so F and differences of F are exact, and a
//   product is rounded once. Rounding is monotone: fl(p) < fl(p') implies p < p'. Only fl(p) == fl(p') leaves a doubt,
//   and no doubt is left while 10 N^3 <= 2^53, that is N <= 2^16 (products exact); beyond, equal products are
//   compared again in 128 bits, where 10 N^3 < 2^79.
// Wide: F is a 128-bit integer and so are the products: 10 N^3 < 2^124 for N <= 2^40, the bound set here: it
//   leaves room for the k-d tree of the checker, which squares differences of absolute coordinates.
// Filtered: as far as Wide, in doubles with a bound on their error, u = 2^-53. x, dy and their differences are exact
//   below 2^53; F = fl(fl(x^2) + fl(dy^2)) has a relative error of at most 2u + u^2. With S_ij = F_i + F_j
//     F_j - F_i                  is off by at most 3.1 u S_ij,
//     p                          by 4.2 u S_bi (x_i - x_a),
//     p - p'                     by 5.3 u (S_bi (x_i - x_a) + S_ia (x_b - x_i)),
//     q                          by 5.3 u S_ij / (2 s (x_j - x_i)),
//   and the bounds, which are computed in doubles too, by a few u of themselves: 8 u = 2^-50 is enough for all.
//   What the bound leaves open is decided in 128 bits from x and dy, which is what a candidate keeps.
#pragma once

#include <cstdint>

#include "core/numbers/int128.hpp"

namespace vorotool::core::tessellation {

inline constexpr std::int64_t exact_product_bound = std::int64_t{1} << 16;
inline constexpr std::int64_t narrow_bound = std::int64_t{1} << 25;
inline constexpr std::int64_t wide_bound = std::int64_t{1} << 40;
inline constexpr double filter_error = 0x1p-50;

struct Narrow {
  using Coordinate = std::int32_t;
  static constexpr Coordinate far = Coordinate{1} << 30;  // beyond every seed; a row can still be subtracted
  using Value = double;                                   // x and F of a candidate
  static constexpr bool filtered = false;
  using Integer = std::int64_t;  // holds any F
};

struct Wide {
  using Coordinate = std::int64_t;
  static constexpr Coordinate far = Coordinate{1} << 61;
  using Value = numbers::int128;
  static constexpr bool filtered = false;
  using Integer = numbers::int128;
};

struct Filtered {
  using Coordinate = std::int64_t;
  static constexpr Coordinate far = Coordinate{1}
                                    << 46;  // its differences are converted to doubles by an addition
  using Value = double;                     // x and dy of a candidate
  static constexpr bool filtered = true;
  using Integer = numbers::int128;
};

}  // namespace vorotool::core::tessellation
