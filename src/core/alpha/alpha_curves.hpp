// Measures of the alpha shapes of all radii, in the plane or in space, by one sweep through the ranks of the radii.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/indices.hpp"
#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"

namespace vorotool::core::alpha {

// Cells are triangles, or tetrahedra in space; walls are their sides. Rank m is that of what never comes in.
struct CurveInput {
  std::size_t spectrum;                     // m radii
  std::span<const std::int32_t> cell_rank;  // [c]
  std::span<const base::IndexPair> sides;   // [w] the cells of each wall, or -1
  std::span<const std::int32_t> wall_rank;  // [w] from which on each is in the way of cavities
  std::span<const double> cell_size, wall_size;
};

// Of the shape from each radius of the spectrum on, until the next: m values each. Sums are carried in twice
// the digits of a double.
struct Curves {
  base::LargeArray<double> content;         // of the cells
  base::LargeArray<double> border;          // size of the walls with one cell
  base::LargeArray<std::int32_t> regions;   // cells joined through walls
  base::LargeArray<std::int32_t> cavities;  // bounded components of what the shape leaves
};

Curves alpha_curves(const CurveInput& input, const base::Monitor& monitor);

// [m] parts of the shape: all that is joined through edges, single points too, of which there are so many at first.
base::LargeArray<std::int32_t> part_counts(std::size_t spectrum, std::size_t points,
                                           std::span<const base::IndexPair> edges,
                                           std::span<const std::int32_t> edge_rank,
                                           const base::Monitor& monitor);

}  // namespace vorotool::core::alpha
