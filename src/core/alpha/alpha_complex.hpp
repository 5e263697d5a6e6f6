// The alpha complex of a Delaunay triangulation (section 2.3): for each edge the radii at which it enters the
// alpha shape, becomes part of its boundary, and goes inside.
//
// For an edge with circumradii R1 <= R2 of the triangles on its sides (infinite where there is none):
//   r_min = half its length, if neither opposite corner is strictly inside the disc on it as diameter (it is
//           a Gabriel edge), else R1;   r_mid = R1;   r_max = R2.
// A center on the other side of a hull edge than the triangle is a corner inside that disc: one rule holds
// for all. If two triangles have one circle, all three radii are its own, and the edge is never in a shape:
// it does not matter which diagonal of a cocircular polygon the triangulation has.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::alpha {

struct EdgeArrays {
  base::LargeArray<std::int32_t> ends;   // [2 e] the smaller index first
  base::LargeArray<std::int32_t> sides;  // [2 e] triangles with this edge, the second one -1 on the hull
};

// The edges of triangles whose neighbors are known, [3 t] each: in the order of the triangles, each edge
// with the first triangle that has it.
EdgeArrays edges_of_triangles(std::span<const std::int32_t> triangles,
                              std::span<const std::int32_t> neighbors, unsigned threads,
                              const base::Monitor& monitor);

struct AlphaInput {
  std::span<const kernel::Point> points;    // finite
  std::span<const std::int32_t> triangles;  // [3 t]
  std::span<const std::int32_t> edges;      // [2 e]
  std::span<const std::int32_t> sides;      // [2 e] triangles with the edge, or -1
};

enum class AlphaRule : std::uint8_t {
  corrected,
  printed,  // the paper's text: r_min is half the length wherever an edge has two triangles
};

// All radii are correctly rounded. The spectrum holds the radii at which the shape changes, each exact value
// once, in increasing order; ranks are places in it, and compare as the exact radii do. An infinite radius
// has the rank behind the last.
struct AlphaArrays {
  base::LargeArray<double> r_min, r_mid, r_max;                 // [e]
  base::LargeArray<std::int32_t> rank_min, rank_mid, rank_max;  // [e]
  base::LargeArray<std::int32_t> triangle_rank;                 // [t]
  base::LargeArray<double> spectrum{0};                         // [m]
  // [m] a triangle with this circumradius, or t + an edge of twice this length
  base::LargeArray<std::int32_t> witness{0};

  AlphaArrays(std::size_t triangles, std::size_t edges)
      : r_min(edges),
        r_mid(edges),
        r_max(edges),
        rank_min(edges),
        rank_mid(edges),
        rank_max(edges),
        triangle_rank(triangles) {}
};

AlphaArrays alpha_complex(const AlphaInput& input, AlphaRule rule, unsigned threads,
                          const base::Monitor& monitor);

}  // namespace vorotool::core::alpha
