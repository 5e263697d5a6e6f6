// Points of space in the order in which they are triangulated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/tetrahedra/point3.hpp"

namespace vorotool::core::tetrahedra {

// Distinct points along a Hilbert curve through the 2^63 cells of a cubic grid over all of them; points of one cell are
// in lexicographic order. The order depends on the points alone.
struct SpatialOrder {
  std::size_t count = 0;
  std::unique_ptr<Point3[]> points;  // [count + 1] the last one is not a number
  std::vector<std::int32_t> index;   // [count] of each point among those given; of equal points, the smallest
};

// `first` receives for each point given the smallest index at the same place.
SpatialOrder spatial_order(std::span<const Point3> points, std::span<std::int32_t> first, unsigned threads,
                           const base::Monitor& monitor);

}  // namespace vorotool::core::tetrahedra
