// Regions of what is farther than a level from all sites.
#pragma once

#include <cstdint>

#include "core/base/disjoint_sets.hpp"
#include "core/base/monitor.hpp"
#include "core/offsets/level_set.hpp"
#include "core/offsets/polygon_faces.hpp"

namespace vorotool::core::offsets {

// Two faces are in one outer component just if a path of edges wholly above the level joins them.
class OuterComponents {
 public:
  OuterComponents(const HalfEdges& borders, const PolygonFaces& domain, const LevelSet& level,
                  const base::Monitor& monitor);

  // The number of the region of a vertex of the diagram that is above (-1: infinity).
  std::int32_t of(std::int32_t vertex) { return sets_.find(vertex < 0 ? infinity_ : vertex); }

  // Regions that are one from now on.
  void join(std::int32_t a, std::int32_t b) { sets_.join(a, b); }

 private:
  std::int32_t infinity_;  // the number after those of the vertices
  base::DisjointSets<std::int32_t> sets_;
};

}  // namespace vorotool::core::offsets
