// When the regions of alpha shapes come and go as the radius grows: the dendrogram of the triangles, cut by
// the elder rule.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"

namespace vorotool::core::alpha {

struct RegionInput {
  std::size_t spectrum;                         // m radii
  std::size_t points;                           // n
  std::span<const std::int32_t> triangles;      // [3 t] corners
  std::span<const std::int32_t> triangle_rank;  // [t] m of a triangle that never comes in
  std::span<const std::int32_t> rank_max;       // [e] from which on both triangles of an edge are in
  std::span<const std::int32_t> sides;          // [2 e] triangles, or -1
  std::span<const double> area;                 // [t]
};

// A region is born with a rank, and dies with the one at which it merges with another that was born earlier;
// of several born with one rank that with the most vertices lives on, then the one whose triangle comes
// first. Regions that merge with the rank they are born with are one. m values stand for "never".
struct Regions {
  std::vector<std::int32_t> birth, death;  // ranks
  std::vector<std::int32_t> into;          // the region that it becomes part of, or -1
  std::vector<std::int32_t> triangle;      // the first one that it is born with
  // Just before it dies, or at last: vertices, triangles and their area.
  std::vector<std::int32_t> vertices, triangles;
  std::vector<double> area;
};

// In the order of births, then of triangles.
Regions region_persistence(const RegionInput& input, const base::Monitor& monitor);

}  // namespace vorotool::core::alpha
