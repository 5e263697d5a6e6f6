// Edges of a segment Voronoi diagram between a segment and its own end: no skeleton has them, but they part
// what is nearest to an end from what is nearest to the inside of its segment.
#pragma once

#include <cstdint>
#include <vector>

#include "core/segment_voronoi/build/diagram.hpp"
#include "core/skeleton/edges.hpp"

namespace vorotool::core::voronoi {

// An edge of a diagram, or a half of one that passes through a point between two segments in one line.
struct Piece {
  std::int32_t edge;
  std::int32_t face;   // of the planar graph, in which it lies as a whole
  std::int32_t point;  // that a half ends in; -1 of a whole edge
  bool is_first;       // the half towards the source
};

struct OwnEnds {
  std::vector<Piece> pieces;  // whole edges, then halves towards sources, then those towards targets
  // [n] Of a point whose cell has no area, since it is between two segments in one line with nothing on one
  // side, the site of the first of these; of others the point itself.
  std::vector<std::int32_t> alias;
};

// Of all edges that are not kept. The faces are those of the diagram's graph.
OwnEnds own_ends(const segment_voronoi::build::DiagramView& diagram, const skeleton::SkeletonEdges& kept);

}  // namespace vorotool::core::voronoi
