// Sites around a disc, drawn so that they do not cross: three of them in the order in which the disc touches
// them, and the disc as exact numbers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "check.hpp"
#include "core/segment_voronoi/discs/certified_disc.hpp"
#include "core/segment_voronoi/discs/exact_disc.hpp"
#include "core/segment_voronoi/discs/records.hpp"
#include "core/segment_voronoi/discs/sites.hpp"

namespace vorotool::tests {

// The ends of segments, by the points' numbers.
using Ends = std::vector<std::array<core::segment_voronoi::discs::SiteIndex, 2>>;

struct Configuration {
  core::segment_voronoi::discs::SegmentSites sites;
  std::array<core::segment_voronoi::discs::SiteIndex, 3> triple;
  std::array<core::kernel::LatticeSite, 3> lattice_sites;
  core::segment_voronoi::discs::ExactDisc disc;
  std::uint8_t left;  // bit i: site i is a segment with the disc to its left

  bool has_end_of(int i) const;  // whether another of the three is an end of site i
  core::segment_voronoi::discs::VoronoiRecord record() const;
  // Found by Newton's method from the rounded disc.
  std::optional<core::segment_voronoi::discs::CertifiedDisc> certified() const;
};

// Of these sites, if they do not cross and a disc with a radius touches them in this order.
std::optional<Configuration> configuration_of(
    core::segment_voronoi::discs::SegmentSites sites,
    const std::array<core::segment_voronoi::discs::SiteIndex, 3>& triple);

// Of points within `most` of the origin. Small ones have ends in common, lines of one direction, and ties.
std::vector<Configuration> configurations(std::uint64_t seed, std::int64_t most, std::size_t count);

core::kernel::LatticePoint drawn_point(Random& random, std::int64_t most);
// Whether the closed sites have more in common than ends.
bool cross_or_overlap(const core::kernel::LatticeSite& s, const core::kernel::LatticeSite& t);

}  // namespace vorotool::tests
