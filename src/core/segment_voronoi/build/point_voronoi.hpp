// The Voronoi diagram of points, as the dual of their Delaunay triangulation.
#pragma once

#include <span>

#include "core/base/monitor.hpp"
#include "core/delaunay/divide_and_conquer.hpp"
#include "core/delaunay/vertex_links.hpp"
#include "core/segment_voronoi/build/segment_insertion.hpp"
#include "core/segment_voronoi/discs/sites.hpp"

namespace vorotool::core::segment_voronoi::build {

// The vertices are the points of the sites, with the rings of their Delaunay triangulation, to which the site
// at infinity is added. Each triangle gives a vertex, in the order of the earliest corners, and so does each
// side of the hull, at infinity: 2 n - 2 of n >= 2 points, by Euler's relation on the sphere. There is room
// for two more for each segment.
VoronoiRecords point_voronoi(const discs::SegmentSites& sites, delaunay::Subdivision& mesh,
                             std::span<delaunay::RingVertex> vertices, unsigned threads,
                             const base::Monitor& monitor);

}  // namespace vorotool::core::segment_voronoi::build
