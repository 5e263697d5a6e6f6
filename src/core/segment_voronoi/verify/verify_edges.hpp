// Whether the edges of a segment Voronoi diagram join the right vertices.
#pragma once

#include <optional>
#include <string>

#include "core/base/monitor.hpp"
#include "core/segment_voronoi/build/diagram.hpp"
#include "core/segment_voronoi/build/incident_segments.hpp"
#include "core/segment_voronoi/verify/closed_sites.hpp"

namespace vorotool::core::segment_voronoi::verify {

// Edges of the same two cells follow each other along their bisector, each from a vertex where it leaves to
// the next one. Vertices must be without faults. Exact.
std::optional<std::string> find_order_fault(const build::RingedDiagram& arrays,
                                            const build::IncidentSegments& incident);

// Points inside every edge: as far from both sites, and no site is nearer. In floating point, up to its
// errors. The vertices' discs must be those of their sites.
std::optional<std::string> find_inner_point_fault(const build::RingedDiagram& arrays,
                                                  const ClosedSites& index, unsigned threads,
                                                  const base::Monitor& monitor);

}  // namespace vorotool::core::segment_voronoi::verify
