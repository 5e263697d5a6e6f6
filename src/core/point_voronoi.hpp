// The Voronoi diagram of points, as the dual of their Delaunay triangulation.
#pragma once

#include "core/divide_and_conquer.hpp"
#include "core/monitor.hpp"
#include "core/segment_insertion.hpp"
#include "core/segment_sites.hpp"

namespace vorotool::core {

// The mesh has the points of the sites for its vertices. Each triangle gives a vertex, and so does each side
// of the hull, at infinity: 2 n - 2 of n >= 2 points, by Euler's relation on the sphere. `room` is at least
// that.
VoronoiRecords point_voronoi(const SegmentSites& sites, const Subdivision& mesh, std::size_t room,
                             unsigned threads, const Monitor& monitor);

}  // namespace vorotool::core
