// The arrays of a skeleton, from the edges of a segment Voronoi diagram that are its own (paper,
// section 3.2).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"
#include "core/segment_voronoi/build/diagram.hpp"
#include "core/skeleton/frame_clip.hpp"

namespace vorotool::core::skeleton {

// Lattice place (x, y) stands for (origin_x + scale x, origin_y + scale y); the scale is a power of two.
struct LatticeToInput {
  double origin_x, origin_y, scale;

  kernel::Point operator()(const kernel::Point& p) const {
    return {origin_x + scale * p.x, origin_y + scale * p.y};
  }
};

struct ClippedGroup {
  std::int32_t group;  // `every_group`: all arcs are clipped
  Frame frame;  // on the lattice
};

// Groups from `first` to before `last`, in which arcs that end in corners at one place are connected there.
struct JoinedGroups {
  std::int32_t first = 0, last = 0;

  bool contain(std::int32_t group) const { return first <= group && group < last; }
};

struct SkeletonArrays {
  std::vector<kernel::Point> vertices;      // [v] in input units, as lengths and control points are
  std::vector<double> radius;               // [v]
  std::vector<std::int8_t> side;            // [v] FrameSide where an arc was cut
  std::vector<base::IndexPair> arcs;        // [a] source and target
  std::vector<kernel::Point> control;       // [a] NaN on straight lines
  std::vector<base::IndexPair> sites;       // [a] left and right
  std::vector<std::int32_t> group, branch;  // [a]
  std::vector<double> length;               // [a]
};

// `edges` and the group of each: arcs are grouped by it, and those of one group may be clipped. Without a
// frame none may be unbounded.
SkeletonArrays extract_skeleton(const segment_voronoi::build::DiagramView& diagram,
                                std::span<const std::int32_t> edges, std::span<const std::int32_t> groups,
                                const std::optional<ClippedGroup>& clipped, const JoinedGroups& joined,
                                const LatticeToInput& place, unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::skeleton
