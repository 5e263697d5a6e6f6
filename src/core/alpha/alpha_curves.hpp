// Measures of the alpha shapes of all radii, by one sweep through the ranks of the radii.
#pragma once

#include <cstdint>
#include <span>

#include "core/alpha/alpha_shape.hpp"
#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"

namespace vorotool::core::alpha {

struct CurveInput {
  std::size_t spectrum;                         // m radii
  std::span<const std::int32_t> triangle_rank;  // [t] m of a triangle that never comes in
  EdgeRanks edges;                              // [e]
  std::span<const std::int32_t> sides;          // [2 e] triangles, or -1
  std::span<const double> area, length;         // [t], [e]
};

// Of the shape from each radius of the spectrum on, until the next: m values each. Sums are carried in twice
// the digits of a double.
struct Curves {
  base::LargeArray<double> area;            // of the triangles
  base::LargeArray<double> perimeter;       // length of the boundary edges
  base::LargeArray<std::int32_t> regions;   // triangles joined through edges
  base::LargeArray<std::int32_t> cavities;  // bounded components of what the triangles leave
  base::LargeArray<std::int32_t> edges;     // singular and boundary ones
};

Curves alpha_curves(const CurveInput& input, const base::Monitor& monitor);

}  // namespace vorotool::core::alpha
