// Whether a vertex of a segment Voronoi diagram is one.
#pragma once

#include <cstddef>

#include "core/base/fault.hpp"
#include "core/segment_voronoi/build/diagram.hpp"
#include "core/segment_voronoi/build/incident_segments.hpp"
#include "core/segment_voronoi/discs/exact_disc.hpp"
#include "core/segment_voronoi/verify/closed_sites.hpp"

namespace vorotool::core::segment_voronoi::verify {

// What is wrong with a vertex whose ring of sites has at least three, all distinct. Nothing if it is the
// center of a disc that exactly the sites of the ring touch, in the order of the ring, and none enters, and
// its values are right to `value_error_bound`.
//
// Floating point with error bounds decides nearly everything; exact numbers decide the rest.
base::Fault find_vertex_fault(const build::DiagramView& arrays, const build::IncidentSegments& incident,
                              const ClosedSites& index, std::size_t vertex);

// The disc of a vertex without faults.
discs::ExactDisc exact_disc_of(const build::DiagramView& arrays, const build::IncidentSegments& incident,
                               std::size_t vertex);

}  // namespace vorotool::core::segment_voronoi::verify
