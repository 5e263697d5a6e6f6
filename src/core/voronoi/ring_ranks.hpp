// The places of sites among those around vertices of a segment Voronoi diagram.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/segment_voronoi/build/diagram.hpp"

namespace vorotool::core::voronoi {

// Sites around a vertex that are gone through one by one: there are three of most.
inline constexpr std::size_t few_sites = 16;

// Throws std::runtime_error if the site is not in the ring.
std::int64_t rank_of(std::span<const std::int32_t> ring, std::int32_t site);

// [k] of a site around a vertex each; where many sites meet, by one sorted list a vertex. Throws as `rank_of` does.
std::vector<std::int64_t> ranks_around(const segment_voronoi::build::DiagramView& diagram,
                                       std::span<const std::int64_t> vertex,
                                       std::span<const std::int64_t> site);

}  // namespace vorotool::core::voronoi
