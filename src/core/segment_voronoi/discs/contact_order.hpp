// The order in which sites touch a disc.
#pragma once

#include <span>

#include "core/segment_voronoi/discs/exact_disc.hpp"

namespace vorotool::core::segment_voronoi::discs {

// Whether the sites, all of which touch the disc of positive radius, do it in counter-clockwise order, once
// around; where several touch at one place, in the order that core/segment_voronoi/discs/exact_disc.hpp
// gives.
bool contacts_in_order(const ExactDisc& disc, std::span<const kernel::LatticeSite> sites);

}  // namespace vorotool::core::segment_voronoi::discs
