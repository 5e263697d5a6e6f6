// Which edges of a segment Voronoi diagram are the skeleton's (paper, section 3.2), and where they lie.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/segment_voronoi/build/diagram.hpp"

namespace vorotool::core::skeleton {

struct SkeletonEdges {
  std::vector<std::int32_t> edge;  // of the diagram, ascending
  std::vector<std::int32_t> face;  // of the planar graph, in which it lies as a whole
};

// All edges but those between a segment and its own end: what the paper deletes by its labels. Each lies in
// one face, since it meets segments only where it ends in a corner. The faces are those of the diagram's
// graph.
//
// No coordinate of a vertex is looked at: a point's cell is in its sector over 180 degrees, an edge from a
// corner between two segments, an unbounded edge in face 0; the rest is in the faces of its neighbors.
SkeletonEdges skeleton_edges(const segment_voronoi::build::DiagramView& diagram, unsigned threads,
                             const base::Monitor& monitor);

}  // namespace vorotool::core::skeleton
