// Distinct points and segments, sorted as a sweep wants them, and what each of them came from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/arrangement/segment_intersections.hpp"
#include "core/base/monitor.hpp"
#include "core/kernel/lattice.hpp"

namespace vorotool::core::arrangement {

// Points in lexicographic order.
struct SortedPoints {
  std::vector<kernel::LatticePoint> points;  // distinct
  std::vector<std::int32_t> rank;            // of each point given, among these
  std::vector<std::int32_t> first;           // of each of these, the smallest index of a point given
};

SortedPoints sort_points(std::span<const kernel::LatticePoint> points, const base::Monitor& monitor);

// For each point the smallest index of one at the same place.
std::vector<std::int32_t> first_at_place(std::span<const kernel::LatticePoint> points,
                                         const base::Monitor& monitor);

// A segment between two different points, and the number of what it came from.
struct Link {
  std::int32_t lower, upper, source;  // lower < upper
};

struct SegmentSet {
  std::vector<kernel::LatticePoint> points;  // sorted
  std::vector<std::int32_t> start;           // as SortedSegments has them
  std::vector<std::int32_t> lower_end, upper_end;
  // Segment s came from source[source_start[s]] ...; ascending
  std::vector<std::int32_t> source_start, source;

  SortedSegments view() const { return {points, start, upper_end, lower_end}; }
  std::size_t size() const { return lower_end.size(); }
  std::span<const std::int32_t> sources_of(std::size_t segment) const {
    return std::span(source).subspan(
        static_cast<std::size_t>(source_start[segment]),
        static_cast<std::size_t>(source_start[segment + 1] - source_start[segment]));
  }
};

// Links with the same ends become one segment. At most 2^31 - 1 links.
SegmentSet join_links(std::vector<kernel::LatticePoint> points, std::vector<Link> links);

}  // namespace vorotool::core::arrangement
