// Regions of what is not far, and how regions are nested.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/disjoint_sets.hpp"
#include "core/offsets/level_crossings.hpp"

namespace vorotool::core::offsets {

// The set {clearance <= level} contains all sites, and the complement of the shapes.
class InnerComponents {
 public:
  InnerComponents(const HalfEdges& borders, const PolygonFaces& domain, const LevelSet& level,
                  const LevelCrossings& crossings, const base::Monitor& monitor);

  // The number of the region of a site.
  std::int32_t of(std::int32_t site) { return sets_.find(site); }

 private:
  base::DisjointSets<std::int32_t> sets_;
};

// A ring is between two regions.
struct RingSides {
  std::int32_t far, near;
};

// Which rings are the outer ones of their shapes, which are the near regions or the far ones. Regions and the
// rings between them are a tree, since a ring parts the plane: seen from the region at infinity, the ring on
// the way to a shape is its outer one.
std::vector<bool> outer_rings(std::span<const RingSides> rings, std::int32_t region_at_infinity,
                              bool shapes_are_near);

}  // namespace vorotool::core::offsets
