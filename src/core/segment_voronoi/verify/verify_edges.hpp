// Whether the edges of a segment Voronoi diagram join the right vertices.
#pragma once

#include "core/base/fault.hpp"
#include "core/base/monitor.hpp"
#include "core/segment_voronoi/build/diagram.hpp"
#include "core/segment_voronoi/build/incident_segments.hpp"
#include "core/segment_voronoi/verify/closed_sites.hpp"

namespace vorotool::core::segment_voronoi::verify {

// Edges of the same two cells follow each other along their bisector, each from a vertex where it leaves to
// the next one. Vertices must be without faults. Exact.
base::Fault find_order_fault(const build::DiagramView& arrays, const build::IncidentSegments& incident);

// Points inside every edge: as far from both sites, and no site is nearer. In floating point, up to its
// errors. The vertices' discs must be those of their sites.
base::Fault find_inner_point_fault(const build::DiagramView& arrays, const ClosedSites& index,
                                   unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::segment_voronoi::verify
