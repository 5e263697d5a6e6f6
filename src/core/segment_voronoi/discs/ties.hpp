// Ties between four segments, and at their ends, by integers alone.
#pragma once

#include <array>
#include <optional>

#include "core/kernel/lattice.hpp"
#include "core/segment_voronoi/discs/records.hpp"
#include "core/segment_voronoi/discs/sites.hpp"

namespace vorotool::core::segment_voronoi::discs {

// Four segments, each with a circle to its left from a to b. A circle touches the lines of the first three,
// and one those of the last three: whether it is one and the same. False also where two of the lines that one
// circle touches are one.
bool is_one_circle(const std::array<kernel::LatticeSite, 4>& segments);

// Discs that touch a segment of theirs at its end p and go through another point q: ties at q are decided in
// integers. For a vertex of these sites: the sign of (center - q) * direction for a segment that leaves q.
// Nothing for a vertex of other sites.
std::optional<int> sign_along_from_end(const SegmentSites& sites, const VoronoiRecord& vertex, SiteIndex q,
                                       SiteIndex segment);

}  // namespace vorotool::core::segment_voronoi::discs
