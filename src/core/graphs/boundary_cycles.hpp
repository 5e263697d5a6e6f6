// The boundaries of the faces of a planar map, gone round half-edge by half-edge.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vorotool::core::graphs {

struct BoundaryCycles {
  std::vector<std::int32_t> start;      // [c + 1] into half_edge
  std::vector<std::int32_t> half_edge;  // [h] along each cycle
};

// Cycles that pass no vertex twice: a boundary that does is taken apart there. `next` is a permutation, the
// half-edge after each one around the face on its left, and `tail` the vertex that each leaves. A cycle begins
// with its smallest half-edge, and cycles are sorted by these. Throws std::invalid_argument if `next`
// is no permutation.
BoundaryCycles boundary_cycles(std::span<const std::int32_t> next, std::span<const std::int32_t> tail,
                               std::size_t vertices);

}  // namespace vorotool::core::graphs
