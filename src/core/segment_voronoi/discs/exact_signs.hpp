// Exact signs for the Voronoi diagram of points and open segments (paper, section 3.2): slow and certain, for
// the calls that floating point leaves open.
//
// Discs are given by three sites in counter-clockwise order of contact
// (core/segment_voronoi/discs/exact_disc.hpp). Sites do not cross, and are distinct. What is no disc throws
// NoDisc.
#pragma once

#include <stdexcept>

#include "core/kernel/lattice.hpp"
#include "core/segment_voronoi/discs/exact_disc.hpp"

namespace vorotool::core::segment_voronoi::discs {

struct NoDisc : std::invalid_argument {
  NoDisc() : std::invalid_argument("no single disc touches the three sites in the order given") {}
};

// Of a disc that is at hand.

// See exact_clearance_sign.
int clearance_sign(const ExactDisc& disc, const kernel::LatticeSite& query);
// The sign of (center - point) * direction.
int side_of_center(const ExactDisc& disc, const kernel::LatticePoint& point,
                   const kernel::LatticeVector& direction);
// The sign of (center of first - center of second) * direction.
int compare_along(const ExactDisc& first, const ExactDisc& second, const kernel::LatticeVector& direction);

// The disc's center on the lattice and its radius: each with a relative error of at most 2^-52.
struct RoundedDisc {
  double x, y, radius;
};
RoundedDisc rounded(const ExactDisc& disc);

// Of discs given by their sites.

// The sign of the distance from the disc's center to the query, as a closed set, less the radius: -1 if the
// query enters the disc, 0 if it only touches, 1 if it stays clear.
int exact_clearance_sign(SiteTriple sites, const kernel::LatticeSite& query);

// Whether the discs, of positive radius, are one: do two Voronoi vertices coincide?
bool exact_same_disc(SiteTriple first, SiteTriple second);

// Does a piece of a Voronoi edge survive in its middle when a segment is inserted?
//
// The edge between the cells of `left` and `right` runs between the centers of two discs that touch both and
// that the query segment enters; its ends are sites already, and enter none of the discs along the edge.
// Gives the sign of the largest clearance along the edge: 1 if it is positive somewhere, -1 if the query
// enters every disc; it is never 0, as then a point site would be inside the query. Where an end p of the
// query is one of the two sites, the clearance is 0 all the way behind p: there the sign of the largest of
// (p - center) * direction counts.
int exact_edge_clearance_sign(const kernel::LatticeSite& left, const kernel::LatticeSite& right,
                              SiteTriple first, SiteTriple second, const kernel::LatticeSite& query);

RoundedDisc exact_disc_rounded(SiteTriple sites);

}  // namespace vorotool::core::segment_voronoi::discs
