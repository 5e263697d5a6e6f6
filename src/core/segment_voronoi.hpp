// The Voronoi diagram of points and open line segments (paper, section 3.2).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/insertion_rounds.hpp"
#include "core/lattice.hpp"
#include "core/monitor.hpp"
#include "core/segment_insertion.hpp"
#include "core/segment_sites.hpp"

namespace vorotool::core {

// A planar straight-line graph: distinct points; segments between them that meet at their ends only, no two
// alike and none of length zero.
struct SegmentGraph {
  std::span<const LatticePoint> points;
  std::span<const std::array<std::int32_t, 2>> segments;
};

class SegmentVoronoi {
 public:
  // Throws std::length_error for more than 2^28 - 1 sites, std::invalid_argument for an index that is out of
  // range, a segment of length zero and two points at one place, and std::logic_error where the diagram would
  // not be planar: the graph is not, or the engine has a defect.
  SegmentVoronoi(const SegmentGraph& graph, unsigned threads, const Monitor& monitor);

  const SegmentVoronoiCounts& counts() const { return counts_; }
  const SegmentSites& sites() const { return sites_; }
  const VoronoiRecords& records() const { return records_; }
  // [sites] the number of each site in the input: points, then segments.
  std::span<const std::int32_t> given() const { return given_; }

 private:
  void make_point_diagram(const SegmentGraph& graph, unsigned threads, const Monitor& monitor);
  void number_sites(const SegmentGraph& graph, std::span<const std::uint32_t> order);

  SegmentSites sites_;
  std::vector<std::int32_t> given_;
  VoronoiRecords records_{0, 0};
  SegmentVoronoiCounts counts_;
};

}  // namespace vorotool::core
