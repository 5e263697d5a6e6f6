// The largest disc inside an outline that covers each pixel.
#pragma once

#include <cstddef>
#include <span>

#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"
#include "core/skeleton/skeleton_view.hpp"

namespace vorotool::core::thickness {

// Centers of pixels: first + (column * step.x, row * step.y); steps are positive.
struct PixelCenters {
  kernel::Point first, step;
  std::size_t width, height;

  kernel::Point place(std::size_t column, std::size_t row) const {
    return {first.x + static_cast<double>(column) * step.x, first.y + static_cast<double>(row) * step.y};
  }
};

// Writes into `diameters`, row by row, the diameter of the largest disc that covers the center of each pixel; 0
// where none does. The discs are those centered on the skeleton, which is whole, and whose outlines have the
// skeleton's sites. A disc covers what is nearer to its center than its radius and `slack`.
void local_thickness(const skeleton::SkeletonView& skeleton, const PixelCenters& pixels, double slack,
                     std::span<double> diameters, unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::thickness
