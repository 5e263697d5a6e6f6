// The seeds of a volume, relative to the middle of its frame.
//
// Let N bound the coordinates of seeds and frame. With one more axis than in sweep_arithmetic.hpp
//   F = x^2 + dy^2 + dz^2                |x| <= N, dy, dz <= 2N         F <= 9 N^2
//   p = (F_b - F_i) (x_i - x_a)          differences <= 9 N^2 and 2N   |p| <= 18 N^3
// Doubles hold every F for N <= 2^24, and every p for N <= 2^16; 128 bits hold the sum of two p for N <= 2^40.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/large_array.hpp"
#include "core/volumes/volume_frame.hpp"

namespace vorotool::core::volumes {

inline constexpr std::int64_t exact_product_bound = std::int64_t{1} << 16;
inline constexpr std::int64_t narrow_bound = std::int64_t{1} << 24;
inline constexpr std::int64_t wide_bound = std::int64_t{1} << 40;

struct Site {
  std::int64_t x, y, z;
  std::uint32_t label;
  std::int32_t column;  // index of x among the distinct ones
};

// Distinct seeds sorted by (z, y, x); of seeds at one place the smallest label stays.
struct VolumeSites {
  base::LargeArray<Site> room;
  std::span<const Site> sites;
  std::int32_t columns = 0;             // distinct x
  std::int64_t largest_coordinate = 0;  // N
  std::size_t duplicates = 0;           // seeds that were left out
  std::uint32_t all_labels = 0;         // with the bits of all of them
};

// Throws tessellation::SeedTooFar beyond wide_bound, std::length_error for more than 2^31 - 1 seeds. The result does not
// depend on the number of threads.
VolumeSites prepare_sites(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
                          std::span<const std::int64_t> z, std::span<const std::uint32_t> label,
                          const VolumeFrame& frame, unsigned threads);

}  // namespace vorotool::core::volumes
