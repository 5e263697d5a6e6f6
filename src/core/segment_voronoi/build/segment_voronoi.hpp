// The Voronoi diagram of points and open line segments (paper, section 3.2).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/kernel/planar_graph_view.hpp"
#include "core/segment_voronoi/build/extraction.hpp"
#include "core/segment_voronoi/build/parallel_insertion.hpp"
#include "core/segment_voronoi/build/segment_insertion.hpp"
#include "core/segment_voronoi/discs/sites.hpp"
#include "core/spatial/morton_grid.hpp"

namespace vorotool::core::segment_voronoi::build {

class SegmentVoronoi {
 public:
  // Throws std::length_error for more than 2^28 - 1 sites, std::invalid_argument for an index that is out of
  // range, a segment of length zero and two points at one place, and std::logic_error where the diagram would
  // not be planar: the graph is not, or the engine has a defect.
  // Sites are put into an order within bounds: those of the points if none are given.
  SegmentVoronoi(const kernel::PlanarGraphView& graph, const std::optional<spatial::Bounds>& within,
                 unsigned threads, const base::Monitor& monitor);

  const SegmentVoronoiCounts& counts() const { return counts_; }
  // Arrays of the diagram: once, then it is gone, and this throws std::logic_error. What is unwanted is left
  // out (core/segment_voronoi/build/extraction.hpp); it throws std::invalid_argument unless nothing or each
  // site has its sides.
  Diagram take_arrays(std::span<const std::uint8_t> unwanted, unsigned threads, const base::Monitor& monitor);

 private:
  void make_point_diagram(const kernel::PlanarGraphView& graph, const std::optional<spatial::Bounds>& within,
                          unsigned threads, const base::Monitor& monitor);
  void number_sites(const kernel::PlanarGraphView& graph, std::span<const std::uint32_t> order);

  discs::SegmentSites sites_;
  std::vector<std::int32_t> given_;  // [sites] the number of each in the input: points, then segments
  std::optional<VoronoiRecords> records_;
  SegmentVoronoiCounts counts_;
};

}  // namespace vorotool::core::segment_voronoi::build
