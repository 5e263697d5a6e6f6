// Points in the order in which they are triangulated.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/delaunay/vertex_links.hpp"
#include "core/kernel/point.hpp"
#include "core/spatial/morton_grid.hpp"

namespace vorotool::core::delaunay {

// Distinct points along a Morton curve through the cells of a grid. In a cell with many points they follow a
// finer curve; points that share a cell of that, or one with few points, are sorted by (x, y).
struct MortonOrder {
  base::LargeArray<RingVertex> vertices;  // with empty rings; as many as there are indices count
  std::vector<std::uint32_t> index;       // of each point among those given; of equal points, the smallest
  std::vector<std::uint32_t> code;        // not decreasing; bits of x and y in turn, x the higher of two
  // The same on the finer curve, 0 in cells without; empty if there are none
  std::vector<std::uint32_t> fine;
};

enum class FineOrder {
  of_crowds,  // the finer curve is one through the bounds of the points in a cell, where these are many
  of_places,  // wherever a cell has several points, it is one through the cell itself
};

// `first` receives for each point given the smallest index at the same place. With the order of places, which
// of two points comes first depends on where they are in the bounds of all, and on no other point. The grid
// is over `within`, which holds all points, if there is one, or else over their bounds.
MortonOrder morton_order(std::span<const kernel::Point> points, std::span<std::int32_t> first, FineOrder fine,
                         unsigned threads, const base::Monitor& monitor,
                         const std::optional<spatial::Bounds>& within = {});

}  // namespace vorotool::core::delaunay
