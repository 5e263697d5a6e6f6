// A segment Voronoi diagram in flat arrays, as what follows from it reads them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/kernel/lattice.hpp"

namespace vorotool::core::segment_voronoi::build {

// Site i < n is point i, site n + j the open segment j. Coordinates are those of the lattice.
struct SegmentDiagram {
  std::span<const kernel::LatticePoint> points;             // [n] distinct
  std::span<const std::array<std::int32_t, 2>> segments;    // [m] ends; segments meet at ends only
  std::span<const std::array<double, 2>> vertices;          // [v]
  std::span<const double> radius;                           // [v] 0 at a corner of segments, and only there
  std::span<const std::array<std::int32_t, 2>> edges;       // [e] source and target, -1 at infinity
  std::span<const std::array<std::int32_t, 2>> edge_sites;  // [e] left and right, from source to target

  bool is_point(std::int32_t site) const { return static_cast<std::size_t>(site) < points.size(); }
  const kernel::LatticePoint& point(std::int32_t site) const {
    return points[static_cast<std::size_t>(site)];
  }
  const std::array<std::int32_t, 2>& ends(std::int32_t segment) const {
    return segments[static_cast<std::size_t>(segment) - points.size()];
  }
  bool is_end(std::int32_t site, std::int32_t segment) const {
    return ends(segment)[0] == site || ends(segment)[1] == site;
  }
  kernel::LatticeSite site(std::int32_t number) const {
    if (is_point(number)) return {point(number), point(number)};
    return {point(ends(number)[0]), point(ends(number)[1])};
  }
};

// A diagram with the sites around each vertex.
struct RingedDiagram : SegmentDiagram {
  std::span<const std::int32_t> vertex_start;  // [v + 1] into vertex_sites
  std::span<const std::int32_t> vertex_sites;  // [k] rings, counter-clockwise from the smallest

  std::size_t vertex_count() const { return radius.size(); }
  std::size_t site_count() const { return points.size() + segments.size(); }
  std::span<const std::int32_t> ring(std::size_t vertex) const {
    const auto start = static_cast<std::size_t>(vertex_start[vertex]);
    return vertex_sites.subspan(start, static_cast<std::size_t>(vertex_start[vertex + 1]) - start);
  }
};

}  // namespace vorotool::core::segment_voronoi::build
