// Arcs of a skeleton cut where they leave a frame.
#pragma once

#include <cstdint>

#include "core/base/monitor.hpp"
#include "core/skeleton/graph.hpp"

namespace vorotool::core::skeleton {

struct Frame {
  double least_x, most_x, least_y, most_y;

  bool holds(const Place& p) const {
    return p[0] >= least_x && p[0] <= most_x && p[1] >= least_y && p[1] <= most_y;
  }
};

// Of the arcs of one group, keeps what lies in the frame: an arc may be cut into several, or end on the frame
// instead of at infinity.
void clip_to_frame(SkeletonGraph& graph, std::int32_t group, const Frame& frame,
                   const base::Monitor& monitor);

}  // namespace vorotool::core::skeleton
