// Arcs of a planar map in order: by their ends, and around their vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/indices.hpp"

namespace vorotool::core::graphs {

// [a] the arcs by their sources, then by their targets; those between the same two as they are given.
std::vector<std::int32_t> arcs_by_ends(std::span<const base::IndexPair> arcs, std::size_t vertices);

// [2 a] the half-edge after each one around the face on its left. Half-edge 2 k goes along arc k, 2 k + 1 back;
// `order` rises counter-clockwise among those that leave a vertex.
std::vector<std::int32_t> next_half_edges(std::span<const base::IndexPair> arcs,
                                          std::span<const std::int64_t> order, std::size_t vertices);

}  // namespace vorotool::core::graphs
