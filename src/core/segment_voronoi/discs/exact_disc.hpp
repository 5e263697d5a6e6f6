// The Voronoi disc of three sites as exact numbers.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/kernel/lattice.hpp"
#include "core/numbers/sqrt_tower.hpp"

namespace vorotool::core::segment_voronoi::discs {

// Three sites in counter-clockwise order of contact around a disc.
//
// The disc touches a point site there, and an open segment at the foot of its center, which lies on the
// closed segment. Sites that touch at one place are in the order of contact that a slightly smaller disc
// tells: around the disc to the left of p -> q a segment p q comes after its end p, and a segment q' p
// before p.
using SiteTriple = std::span<const kernel::LatticeSite, 3>;

// center = origin + (x, y) / w, radius^2 = z / w^2, w > 0.
struct ExactDisc {
  std::shared_ptr<const numbers::SqrtTower> tower;  // of x, y, w and z
  kernel::LatticePoint origin;
  numbers::RootNumber x, y, w, z;
};

// The disc, or nothing if none touches the sites in this order, or infinitely many do (two collinear segments
// and their common end). Where the order alone does not settle which of the circles tangent to the sites'
// lines it is, it is the one whose feet lie on the segments: one at most, as segments do not cross. Elsewhere
// the feet are not looked at.
std::optional<ExactDisc> find_exact_disc(SiteTriple sites);

// Whether the disc touches the site: at the point, or at a foot on the closed segment.
bool touches(const ExactDisc& disc, const kernel::LatticeSite& site);

}  // namespace vorotool::core::segment_voronoi::discs
