// The edges of a segment Voronoi diagram put together to a map on the sphere.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/fault.hpp"
#include "core/segment_voronoi/build/diagram.hpp"
#include "core/segment_voronoi/build/incident_segments.hpp"

namespace vorotool::core::segment_voronoi::verify {

// The cells that meet at infinity, clockwise, which is counter-clockwise around infinity on the sphere: the
// points of the convex hull, those inside its sides too, and the segments between consecutive ones. Of points
// on one line the chain there and back. The same site may come twice.
std::vector<std::int32_t> cells_at_infinity(const build::DiagramView& arrays,
                                            const build::IncidentSegments& incident);

// What is wrong with the rings and the edges as a map, whatever the values: with infinity as a further
// vertex, every pair of successive sites of a ring has one edge there and each edge such a place at both of
// its ends; the edges around each cell make one cycle; all is connected; and Euler's relation holds. Indices
// must be in range, and sites distinct in each ring.
base::Fault find_map_fault(const build::DiagramView& arrays, const build::IncidentSegments& incident);

}  // namespace vorotool::core::segment_voronoi::verify
