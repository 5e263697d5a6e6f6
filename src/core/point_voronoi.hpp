// The Voronoi diagram of points, as the dual of their Delaunay triangulation.
#pragma once

#include "core/half_edges.hpp"
#include "core/monitor.hpp"
#include "core/segment_insertion.hpp"
#include "core/segment_sites.hpp"

namespace vorotool::core {

// The Delaunay triangulation has the points of the sites for its vertices; `hull` goes counter-clockwise
// along the hull, and is none of fewer than two points. Each triangle gives a vertex, and so does each side
// of the hull, at infinity: 2 n - 2 of n >= 2 points, by Euler's relation on the sphere. `room` is at least
// that.
VoronoiRecords point_voronoi(const SegmentSites& sites, const HalfEdges& edges, HalfEdge hull,
                             std::size_t room, unsigned threads, const Monitor& monitor);

}  // namespace vorotool::core
