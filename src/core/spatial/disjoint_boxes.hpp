// Boxes divided into sheets: those of one sheet have no point in common.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"

namespace vorotool::core::spatial {

// Closed: both corners belong to it.
struct ClosedBox {
  std::int64_t least_x, least_y, most_x, most_y;
};

// [n] the sheet of each box, from 0 without gaps. Boxes are taken from left to right, each into the first of
// some sheets where it meets none. What fits into none of these is divided by the largest power of two that
// has a multiple among its rows: boxes with the same multiple are all cut by one line, so that they share
// sheets as intervals of columns do, as few as may be; those with different multiples of one power never
// meet. There are at most a constant and 64 times as many sheets as boxes have a point in common; time
// O(n log n).
std::vector<std::int32_t> disjoint_sheets(std::span<const ClosedBox> boxes, const base::Monitor& monitor);

}  // namespace vorotool::core::spatial
