// The curves at one distance from all sites, as crossings with the edges of their Voronoi diagram.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"
#include "core/offsets/half_edges.hpp"
#include "core/offsets/polygon_faces.hpp"

namespace vorotool::core::offsets {

// Where a crossing is: inside an edge, at the vertex where its half-edge ends, as far as doubles tell, or where
// two regions of what is near only touch each other.
enum Ending : std::int8_t { inside, at_vertex, touching };

// What the arc is that goes on from a crossing: that of a whole cell; none, since it is about a point between
// two segments on one line; or one of which rounding leaves nothing.
enum Arc : std::int8_t { ordinary, aligned, lost };

// A curve, what is near on its left, comes to a crossing through the cell on the left of its half-edge and goes
// on in the one on the right.
struct LevelMap {
  std::vector<std::int32_t> half_edge;  // [c] on which the clearance falls to the level
  std::vector<std::int32_t> across;     // [c] the crossing where the curve comes out of the next cell
  std::vector<std::int8_t> ending;      // [c] an Ending
  std::vector<std::int8_t> arc;         // [c] an Arc
  std::vector<kernel::Point> place;     // [c]
  std::vector<kernel::Point> middle;    // [c] of an arc of half a circle or more, or nearly so; NaN of others
  std::vector<std::int32_t> circles;    // points that a whole circle is about
};

// The level is positive, in lattice units.
LevelMap level_map(const HalfEdges& borders, const PolygonFaces& domain, double level,
                   const base::Monitor& monitor);

}  // namespace vorotool::core::offsets
