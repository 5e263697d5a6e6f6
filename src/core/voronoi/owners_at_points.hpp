// Who owns the segments that end at points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/indices.hpp"

namespace vorotool::core::voronoi {

// [n] each: of the owners of a point's segments the smallest, and the largest; where no segment ends, the
// largest number and -1.
struct OwnersAtPoints {
  std::vector<std::int32_t> least, most;
};

OwnersAtPoints owners_at_points(std::span<const base::IndexPair> segments,
                                std::span<const std::int32_t> owner, std::size_t points);

}  // namespace vorotool::core::voronoi
