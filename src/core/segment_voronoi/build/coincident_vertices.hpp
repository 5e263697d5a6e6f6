// Whether two neighboring vertices of a segment Voronoi diagram are at one place: ties.
#pragma once

#include "core/segment_voronoi/discs/records.hpp"
#include "core/segment_voronoi/discs/sites.hpp"

namespace vorotool::core::segment_voronoi::build {

// For vertices u and w at the ends of edge i of u, both finite.
bool are_coincident(const discs::SegmentSites& sites, const discs::VoronoiRecord& u, int i,
                    const discs::VoronoiRecord& w);

}  // namespace vorotool::core::segment_voronoi::build
