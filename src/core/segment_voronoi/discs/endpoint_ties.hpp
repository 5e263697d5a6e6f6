// Discs that touch a segment of theirs at its end p and go through another point q: ties at q are decided in
// integers.
#pragma once

#include <optional>

#include "core/segment_voronoi/discs/records.hpp"
#include "core/segment_voronoi/discs/sites.hpp"

namespace vorotool::core::segment_voronoi::discs {

// For a vertex of these sites: the sign of (centre - q) * direction for a segment that leaves q. Nothing for
// a vertex of other sites.
std::optional<int> sign_along_from_end(const SegmentSites& sites, const VoronoiRecord& vertex, SiteIndex q,
                                       SiteIndex segment);

}  // namespace vorotool::core::segment_voronoi::discs
