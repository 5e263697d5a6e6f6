// The plane sweep of segments along the axes that meet at common ends only, such as the cracks between
// pixels.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/arrangement/segment_intersections.hpp"
#include "core/base/monitor.hpp"

namespace vorotool::core::arrangement {

// The `below` of sweep_segments for segments that do not meet; nothing if some meet, if a segment is
// not along an axis, or if the points lie in too many rows for their number. The segments that a column cuts
// are a set of rows: no order has to be searched by the places of segments.
std::optional<std::vector<std::int32_t>> sweep_rectilinear(const SortedSegments& segments,
                                                           const base::Monitor& monitor);

}  // namespace vorotool::core::arrangement
