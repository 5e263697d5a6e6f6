// Straight lines along the bisectors of corners, which complete an approximate skeleton.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"
#include "core/sampled_skeleton/sample_diagram.hpp"

namespace vorotool::core::sampled_skeleton {

// From a corner under 180 degrees, in the face between two edges, to the first kept Voronoi edge.
struct CornerBisector {
  std::int32_t corner;       // point of the graph
  std::int32_t right, left;  // segments: counter-clockwise from the first to the second
  std::int32_t face;
  Triangle node = -1;             // it ends in the circumcenter of this
  Side side = -1;                 // or else inside the Voronoi edge of this side of the corner
  double along = 0;               // how far from the corner that is
  kernel::Point direction{0, 0};  // a unit vector
};

struct CornerBisectors {
  std::vector<CornerBisector> lines;
  std::size_t open = 0;  // corners without: a piece or a deleted edge is met first
};

// For the corners in faces that are wanted. Which edge the bisector meets first is decided exactly, for its
// direction as it is rounded to 53 bits.
CornerBisectors corner_bisectors(const SampleDiagram& diagram, std::span<const std::int32_t> face_group,
                                 unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::sampled_skeleton
