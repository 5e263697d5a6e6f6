// Lattice coordinates as small integers of the same order: those of pixels are multiples of a large power of
// two.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

#include "core/kernel/lattice.hpp"

namespace vorotool::core::arrangement {

// Counted from the lowest one, in steps of the largest power of two that divides all differences.
class CoordinateCompression {
 public:
  CoordinateCompression(std::span<const kernel::LatticePoint> points,
                        std::int32_t kernel::LatticePoint::* coordinate) {
    if (points.empty()) return;
    const std::int32_t first = points.front().*coordinate;
    std::int32_t low = first, high = first;
    std::uint32_t differing = 0;  // has the same lowest bit as the differences from the first one
    for (const kernel::LatticePoint& point : points) {
      const std::int32_t c = point.*coordinate;
      low = std::min(low, c);
      high = std::max(high, c);
      differing |= static_cast<std::uint32_t>(c ^ first);
    }
    low_ = static_cast<std::uint32_t>(low);
    shift_ = differing == 0 ? 0 : std::countr_zero(differing);
    last_ = of(high);
  }

  // Below 2^31, as differences are.
  std::uint32_t of(std::int32_t coordinate) const {
    return (static_cast<std::uint32_t>(coordinate) - low_) >> shift_;
  }
  std::uint32_t last() const { return last_; }
  int bits() const { return static_cast<int>(std::bit_width(last_)); }

 private:
  std::uint32_t low_ = 0, last_ = 0;
  int shift_ = 0;
};

}  // namespace vorotool::core::arrangement
