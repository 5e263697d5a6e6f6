// Lines, and arcs of a skeleton, cut where they leave a frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"
#include "core/skeleton/graph.hpp"

namespace vorotool::core::skeleton {

struct Frame {
  double least_x, most_x, least_y, most_y;

  bool holds(const kernel::Point& p) const {
    return p.x >= least_x && p.x <= most_x && p.y >= least_y && p.y <= most_y;
  }
};

// A place on an arc by its parameter, and the side of the frame that cuts it there.
struct Cut {
  double t;
  FrameSide side;
};

// A straight arc, or a ray, or a whole line: base + t way.
struct Line {
  kernel::Point base, way;
  double from, to;

  kernel::Point place(double t) const { return {base.x + t * way.x, base.y + t * way.y}; }
};

// Where the part of a line in the frame begins and ends; nothing if there is none.
inline std::optional<std::pair<Cut, Cut>> cut_line(const Line& line, const Frame& frame) {
  Cut first{line.from, FrameSide::none}, last{line.to, FrameSide::none};
  const double base[2] = {line.base.x, line.base.y}, way[2] = {line.way.x, line.way.y};
  const double least[2] = {frame.least_x, frame.least_y}, most[2] = {frame.most_x, frame.most_y};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (way[axis] == 0) {
      if (base[axis] < least[axis] || base[axis] > most[axis]) return {};
      continue;
    }
    Cut enter{(least[axis] - base[axis]) / way[axis], axis == 0 ? FrameSide::least_x : FrameSide::least_y};
    Cut leave{(most[axis] - base[axis]) / way[axis], axis == 0 ? FrameSide::most_x : FrameSide::most_y};
    if (way[axis] < 0) std::swap(enter, leave);
    if (enter.t > first.t) first = enter;
    if (leave.t < last.t) last = leave;
  }
  if (!(first.t < last.t)) return {};
  return std::pair{first, last};
}

inline constexpr std::int32_t every_group = -1;

// Of the arcs of one group, or of `every_group`, keeps what lies in the frame: an arc may be cut into several, or end on the frame
// instead of at infinity.
void clip_to_frame(SkeletonGraph& graph, std::int32_t group, const Frame& frame,
                   const base::Monitor& monitor);

}  // namespace vorotool::core::skeleton
