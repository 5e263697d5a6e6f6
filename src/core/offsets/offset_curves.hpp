// Curves at one distance from sites: rings of straight lines and circular arcs, from the clearance along the
// edges of their Voronoi diagram.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"
#include "core/offsets/half_edges.hpp"
#include "core/offsets/polygon_faces.hpp"
#include "core/skeleton/extraction.hpp"

namespace vorotool::core::offsets {

// Pieces follow each other around their rings, rings in their shapes: the outer one first, then those of
// holes. A piece begins where the one before it ends, to the bit. The shape is on the left.
struct OffsetCurves {
  std::vector<kernel::Point> start, end;    // [k] in input units
  std::vector<kernel::Point> center;        // [k] NaN on straight lines; an arc is at most half a circle
  std::vector<std::int32_t> site;           // [k] what it is at that distance from
  std::vector<std::int64_t> ring_start;     // [q + 1]
  std::vector<std::int64_t> shape_start;    // [s + 1] among the rings
  std::vector<std::int32_t> shape_polygon;  // [s] the first one, -1 of several features
};

// Outwards: the border of what is no farther than the distance from the shapes. Inwards: of what is inside
// them and farther from all sites. The distance, in input units, is positive both ways.
//
// Half-edges that descend from above the level are where the curve goes from cell to cell. Both decisions of
// the topology, whether a vertex is above and whether an edge dips between its ends, are made once: rings
// are closed and properly nested whatever the rounding of radii.
OffsetCurves offset_curves(const HalfEdges& borders, const PolygonFaces& domain, double distance,
                           const skeleton::LatticeToInput& place, const base::Monitor& monitor);

}  // namespace vorotool::core::offsets
