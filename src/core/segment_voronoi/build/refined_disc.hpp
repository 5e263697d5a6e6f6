// Center and radius of a finished Voronoi vertex.
#pragma once

#include <span>

#include "core/segment_voronoi/discs/records.hpp"
#include "core/segment_voronoi/discs/sites.hpp"

namespace vorotool::core::segment_voronoi::build {

struct RefinedDisc {
  double x, y, radius;
};

// A site that a disc touches, and whether the disc lies to the left of it.
struct Contact {
  discs::SiteIndex site;
  bool is_left;
};

// The disc of a vertex that touches three sites or more, in a canonical order: the numbers depend on nothing
// else. They err by at most 2^-48 of the radius and of the coordinates, in practice by three ulp.
RefinedDisc refined_disc(const discs::SegmentSites& sites, const discs::VoronoiRecord& record,
                         std::span<const Contact> contacts);

}  // namespace vorotool::core::segment_voronoi::build
