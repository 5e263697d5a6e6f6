// Points in the order in which they are triangulated.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/predicates.hpp"

namespace vorotool::core {

// Distinct points along a Morton curve; points that share a cell of it are sorted by (x, y).
struct MortonOrder {
  std::vector<Point> points;
  std::vector<std::uint32_t> index;  // of each point among those given; of equal points, the smallest
  std::vector<std::uint32_t> code;   // not decreasing; bits of x and y in turn, x the higher of two
};

// `first` receives for each point given the smallest index at the same place.
MortonOrder morton_order(std::span<const Point> points, std::span<std::int32_t> first);

}  // namespace vorotool::core
