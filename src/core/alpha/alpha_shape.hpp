// One alpha shape out of an alpha complex: its edges, regions and rings.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::alpha {

// Classes of edges in a shape: outside, without a triangle (singular), with one (regular), with two (interior).
enum class EdgeClass : std::uint8_t { outside, singular, boundary, interior };

struct EdgeRanks {
  std::span<const std::int32_t> min, mid, max;  // [e]
};

struct ShapeEdges {
  base::LargeArray<std::int32_t> edge;  // singular and boundary ones, increasing; `count` of them
  base::LargeArray<std::uint8_t> kind;  // an EdgeClass each
  std::size_t count;
};

// The edges of the shape in which ranks below `reached` have come; edges enter at ranks below `entered`,
// which differs only where intervals are open.
ShapeEdges shape_edges(const EdgeRanks& ranks, std::int32_t reached, std::int32_t entered, unsigned threads,
                       const base::Monitor& monitor);

// Components of the triangles inside and of those outside, joined through edges; the unbounded face, number
// -1, takes part outside. Numbers count from 0 on each side, in the order of the first triangle.
std::vector<std::int32_t> connected_triangles(std::span<const std::uint8_t> is_inside,
                                              std::span<const std::int32_t> sides,
                                              const base::Monitor& monitor);

// Closed rings of directed boundary edges a[i] -> b[i] that have a region on their left.
struct Rings {
  std::vector<std::int32_t> vertex;   // of all rings, one after the other; the first one is not repeated
  std::vector<std::int32_t> start;    // [rings + 1]
  std::vector<std::int32_t> region;   // [rings]
  std::vector<std::uint8_t> is_hole;  // [rings] whether it goes clockwise
};

// Where a region meets itself at a vertex, a ring goes on along the part outside that it came along: so no
// ring visits a vertex twice, a region has one ring that is counter-clockwise, and holes touch it at most in
// points.
Rings trace_rings(std::span<const kernel::Point> points, std::span<const std::int32_t> a,
                  std::span<const std::int32_t> b, std::span<const std::int32_t> region,
                  const base::Monitor& monitor);

}  // namespace vorotool::core::alpha
