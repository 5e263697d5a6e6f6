// The segments that end at each point, counter-clockwise.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/groups.hpp"
#include "core/kernel/planar_graph_view.hpp"

namespace vorotool::core::segment_voronoi::build {

class IncidentSegments {
 public:
  explicit IncidentSegments(const kernel::PlanarGraphView& graph);

  // Site numbers of the segments at a point, counter-clockwise from the positive x axis.
  std::span<const std::int32_t> at(std::int32_t point) const { return segments_[point]; }
  // The site number of the segment between two points, or -1.
  std::int32_t between(std::int32_t p, std::int32_t q) const;

  // The cells that meet at a corner in a disc of radius 0: the segments, and the point itself in a gap of 180
  // degrees or more. Empty where no vertex is: fewer than two segments, or two on one line.
  std::vector<std::int32_t> corner_ring(std::int32_t point) const;
  // Whether all gaps are under 180 degrees: then the point has no cell.
  bool has_no_cell(std::int32_t point) const;

 private:
  // Where the gap after segment i at a point is 180 degrees or more.
  bool wide_gap_after(std::int32_t point, std::size_t i) const;

  kernel::PlanarGraphView graph_;
  base::Groups<std::int32_t> segments_;
};

}  // namespace vorotool::core::segment_voronoi::build
