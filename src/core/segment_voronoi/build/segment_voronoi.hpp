// The Voronoi diagram of points and open line segments (paper, section 3.2).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/kernel/lattice.hpp"
#include "core/segment_voronoi/build/extraction.hpp"
#include "core/segment_voronoi/build/parallel_insertion.hpp"
#include "core/segment_voronoi/build/segment_insertion.hpp"
#include "core/segment_voronoi/discs/sites.hpp"
#include "core/spatial/morton_grid.hpp"

namespace vorotool::core::segment_voronoi::build {

// A planar straight-line graph: distinct points; segments between them that meet at their ends only, no two
// alike and none of length zero.
struct SegmentGraph {
  std::span<const kernel::LatticePoint> points;
  std::span<const std::array<std::int32_t, 2>> segments;
  std::optional<spatial::Bounds>
      within;  // what sites are put into an order in, if not the bounds of the points
};

class SegmentVoronoi {
 public:
  // Throws std::length_error for more than 2^28 - 1 sites, std::invalid_argument for an index that is out of
  // range, a segment of length zero and two points at one place, and std::logic_error where the diagram would
  // not be planar: the graph is not, or the engine has a defect.
  SegmentVoronoi(const SegmentGraph& graph, unsigned threads, const base::Monitor& monitor);

  const SegmentVoronoiCounts& counts() const { return counts_; }
  // Arrays of the diagram: once, then it is gone, and this throws std::logic_error. What is unwanted is left
  // out (core/segment_voronoi/build/extraction.hpp); it throws std::invalid_argument unless nothing or each
  // site has its sides.
  DiagramArrays take_arrays(std::span<const std::uint8_t> unwanted, unsigned threads,
                            const base::Monitor& monitor);

 private:
  void make_point_diagram(const SegmentGraph& graph, unsigned threads, const base::Monitor& monitor);
  void number_sites(const SegmentGraph& graph, std::span<const std::uint32_t> order);

  discs::SegmentSites sites_;
  std::vector<std::int32_t> given_;  // [sites] the number of each in the input: points, then segments
  std::optional<VoronoiRecords> records_;
  SegmentVoronoiCounts counts_;
};

}  // namespace vorotool::core::segment_voronoi::build
