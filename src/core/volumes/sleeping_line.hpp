// Lines in the (row, slice) plane that bound where a seed may be nearest, with roundings on the safe side.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace vorotool::core::volumes {

// Of every rounded value here, relative to what it is a sum of; far more than the roundings.
inline constexpr double rounding = 0x1p-45;

// Of what is relative to a row, of which there are at most 2^30.
inline constexpr double row_rounding = 0x1p-14;

// row = at + slope * slice.
struct Line {
  double at;
  double slope;

  double row(double slice) const { return at + slope * slice; }
  double error(double slice) const {
    return rounding * (std::fabs(at) + std::fabs(slope * slice)) + row_rounding;
  }
  double least_row(double slice) const { return row(slice) - error(slice); }
  double most_row(double slice) const { return row(slice) + error(slice); }
};

// The rows of a slice between two lines; without lines all.
struct Wedge {
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  Line lower{-infinity, 0.0};
  Line upper{infinity, 0.0};

  // The first row and the last one of a slice that may be between, of `rows`; none if the last is before it.
  std::int32_t first_row(std::int32_t slice, std::int32_t rows) const {
    const double row = std::ceil(lower.least_row(slice));
    return row <= 0 ? 0 : row >= rows ? rows : static_cast<std::int32_t>(row);
  }
  std::int32_t last_row(std::int32_t slice, std::int32_t rows) const {
    const double row = std::floor(upper.most_row(slice));
    return row >= rows - 1 ? rows - 1 : row < 0 ? -1 : static_cast<std::int32_t>(row);
  }

  // The first slice after one without rows that may have some; `never` if none has.
  static constexpr std::int32_t never = std::numeric_limits<std::int32_t>::max();
  std::int32_t opening(std::int32_t slice, std::int32_t rows) const {
    double after = slice + 1.0;
    const auto wait = [&](double lack, double slope, double size) {
      if (!(lack > 0)) return;
      if (slope >= rounding * size) {
        after = infinity;
      } else if (slope < -rounding * size) {
        after = std::fmax(after, slice + std::floor(lack / -slope * (1 - 0x1p-20)));
      }
    };
    wait(lower.least_row(slice) - (rows - 1), lower.slope, std::fabs(lower.slope));
    wait(-upper.most_row(slice), -upper.slope, std::fabs(upper.slope));
    if (std::isfinite(lower.at) && std::isfinite(upper.at)) {
      wait(lower.least_row(slice) - upper.most_row(slice), lower.slope - upper.slope,
           std::fabs(lower.slope) + std::fabs(upper.slope));
    }
    return after >= never ? never : static_cast<std::int32_t>(after);
  }
};

// The least whole number of steps after which a value that falls by `fall` a step is surely not above 0, or one less.
inline double steps_to_zero(double value, double fall) {
  return std::fmax(1.0, std::ceil(value / fall * (1 - rounding)));
}

}  // namespace vorotool::core::volumes
