// The seeds of a tessellation in the order of the sweep, relative to the middle of the frame.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

namespace vorotool::core::tessellation {

// Steps of the lattice on which squared distances are sums of squares.
struct Steps {
  std::int64_t x, y;
};

// Pixel (c, r) of the frame has its center at (scale * (x + c), scale * (y + r)) in the coordinates of seeds, of which
// one is `unit` steps of the lattice along each axis: pixels are rectangles of scale * unit steps.
struct FrameOnLattice {
  std::int64_t x, y;
  std::int32_t width, height;
  std::int64_t scale;  // 1, 2, 4, ...
  Steps unit;

  std::int32_t middle_column() const { return width / 2; }
  std::int32_t middle_row() const { return height / 2; }
  // Sides of a pixel on the lattice.
  Steps pixel() const { return {scale * unit.x, scale * unit.y}; }
  // Lattice y of a row, relative to the middle of the frame.
  std::int64_t row_y(std::int64_t row) const { return pixel().y * (row - middle_row()); }
};

// Seeds too far from the frame for exact arithmetic; carries the first of them and the largest allowed
// distance.
struct SeedTooFar : std::range_error {
  SeedTooFar(std::size_t index, std::int64_t bound);
  std::size_t index;
  std::int64_t bound;
};

// Distinct seeds sorted by (y, x); of seeds at one place the smallest label stays. Seeds outside the frame
// that are nearest to no pixel may be left out.
struct Sites {
  std::vector<std::int64_t> y;       // [n] relative to the middle of the frame, not decreasing
  std::vector<std::int32_t> column;  // [n] index into column_x; increasing where y is equal
  std::vector<std::uint32_t> label;  // [n]
  // [columns] distinct x, increasing, relative to the middle of the frame
  std::vector<std::int64_t> column_x;
  std::int64_t largest_coordinate;  // N of sweep_arithmetic.hpp: bounds seeds and frame
  std::size_t duplicates;           // seeds that were left out

  std::size_t size() const { return y.size(); }
  // Number of seeds at or above a line.
  std::int32_t count_to(std::int64_t line) const {
    return static_cast<std::int32_t>(std::upper_bound(y.begin(), y.end(), line) - y.begin());
  }
};

// Throws SeedTooFar when sweep_arithmetic.hpp's wide bound does not hold, std::length_error for more than
// 2^31 - 1 seeds.
Sites prepare_sites(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
                    std::span<const std::uint32_t> label, const FrameOnLattice& frame);

}  // namespace vorotool::core::tessellation
