// The cells of a square grid over points, numbered along a Morton curve.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/kernel/point.hpp"

namespace vorotool::core::spatial {

// The smallest box around points, at least one.
struct Bounds {
  explicit Bounds(const kernel::Point& p) : least(p), most(p) {}

  void add(const kernel::Point& p) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y)};
  }
  bool holds(const kernel::Point& p) const {
    return p.x >= least.x && p.y >= least.y && p.x <= most.x && p.y <= most.y;
  }

  kernel::Point least, most;
};

// 16 bits of each coordinate: enough to tell most points apart, and three passes of a radix sort.
inline constexpr int morton_cell_bits = 16;

// Points of one cell of the grid that get a finer grid among themselves are more than this.
inline constexpr std::size_t morton_crowd = 64;

// Cells have one size in both directions. Every step rounds monotonically, so a smaller cell means a smaller
// coordinate. Halves keep the range of the largest doubles finite.
class MortonGrid {
 public:
  explicit MortonGrid(const Bounds& bounds) : half_least_{bounds.least.x / 2, bounds.least.y / 2} {
    const double half_range =
        std::max(bounds.most.x / 2 - bounds.least.x / 2, bounds.most.y / 2 - bounds.least.y / 2);
    // A range below 2^-960 is blown up in two exact steps, where one factor would be infinite.
    blow_up_ = half_range < 0x1p-960 ? 0x1p120 : 1.0;
    factor_ = half_range > 0 ? last / (half_range * blow_up_) : 0.0;
  }

  // Bits of column and row in turn, those of the column the higher of two.
  std::uint32_t code(const kernel::Point& p) const {
    return spread(cell(p.x, half_least_.x)) << 1 | spread(cell(p.y, half_least_.y));
  }
  // The same of a grid as fine again in the point's own cell.
  std::uint32_t fine_code(const kernel::Point& p) const {
    return spread(part(p.x, half_least_.x)) << 1 | spread(part(p.y, half_least_.y));
  }

 private:
  static constexpr double last = (1 << morton_cell_bits) - 1;

  double place(double v, double half_least) const {
    return std::min((v / 2 - half_least) * blow_up_ * factor_, last);
  }
  std::uint32_t cell(double v, double half_least) const {
    return static_cast<std::uint32_t>(place(v, half_least));
  }
  // Exact, as the place less its whole part is.
  std::uint32_t part(double v, double half_least) const {
    return static_cast<std::uint32_t>((place(v, half_least) - cell(v, half_least)) * (1 << morton_cell_bits));
  }

  // Puts the 16 bits of v at the even places.
  static std::uint32_t spread(std::uint32_t v) {
    v = (v | v << 8) & 0x00ff00ffU;
    v = (v | v << 4) & 0x0f0f0f0fU;
    v = (v | v << 2) & 0x33333333U;
    return (v | v << 1) & 0x55555555U;
  }

  kernel::Point half_least_;
  double blow_up_, factor_;
};

}  // namespace vorotool::core::spatial
