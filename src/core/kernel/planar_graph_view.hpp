// A planar straight-line graph on the lattice in flat arrays, as what follows from it reads them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/indices.hpp"
#include "core/kernel/lattice.hpp"

namespace vorotool::core::kernel {

// Its points and open segments are the sites of Voronoi diagrams: site i < n is point i,
// site n + j segment j.
struct PlanarGraphView {
  std::span<const LatticePoint> points;       // [n] distinct
  std::span<const base::IndexPair> segments;  // [m] ends; segments meet at ends only
  // [m] left and right of each segment; 0 is the unbounded one. Empty where they are not looked at.
  std::span<const base::IndexPair> faces;

  std::size_t site_count() const { return points.size() + segments.size(); }
  bool is_point(std::int32_t site) const { return base::at(site) < points.size(); }
  const LatticePoint& point(std::int32_t site) const { return points[base::at(site)]; }
  // The number of a site that is no point among the segments.
  std::size_t segment_of(std::int32_t site) const { return base::at(site) - points.size(); }
  const base::IndexPair& ends(std::int32_t site) const { return segments[segment_of(site)]; }
  bool is_end(std::int32_t point, std::int32_t site) const {
    return ends(site)[0] == point || ends(site)[1] == point;
  }
  // Along the segment, from an end of it.
  LatticeVector way_from(std::int32_t point_at_end, std::int32_t site) const {
    const auto [a, b] = ends(site);
    return point(a == point_at_end ? b : a) - point(point_at_end);
  }
  LatticeSite site(std::int32_t number) const {
    return is_point(number) ? LatticeSite{point(number), point(number)} : segment(segment_of(number));
  }
  LatticeSite segment(std::size_t j) const { return {point(segments[j][0]), point(segments[j][1])}; }
};

}  // namespace vorotool::core::kernel
