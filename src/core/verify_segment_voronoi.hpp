// An exact check of a segment Voronoi diagram that knows its arrays only, not how they were made.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/lattice.hpp"
#include "core/monitor.hpp"

namespace vorotool::core {

// Site i < n is point i, site n + j the open segment j.
struct SegmentVoronoiArrays {
  std::span<const LatticePoint> points;                     // [n] distinct
  std::span<const std::array<std::int32_t, 2>> segments;    // [m] ends; segments meet at ends only
  std::span<const double> vertices;                         // [2 v] centres x, y
  std::span<const double> radius;                           // [v]
  std::span<const std::int32_t> vertex_start;               // [v + 1] into vertex_sites
  std::span<const std::int32_t> vertex_sites;               // [k] rings, counter-clockwise from the smallest
  std::span<const std::array<std::int32_t, 2>> edges;       // [e] source and target, -1 at infinity
  std::span<const std::array<std::int32_t, 2>> edge_sites;  // [e] on the left and on the right

  std::size_t vertex_count() const { return radius.size(); }
  std::size_t site_count() const { return points.size() + segments.size(); }
  bool is_point(std::int32_t site) const { return static_cast<std::size_t>(site) < points.size(); }
  const LatticePoint& point(std::int32_t site) const { return points[static_cast<std::size_t>(site)]; }
  const std::array<std::int32_t, 2>& ends(std::int32_t segment) const {
    return segments[static_cast<std::size_t>(segment) - points.size()];
  }
  bool is_end(std::int32_t site, std::int32_t segment) const {
    return ends(segment)[0] == site || ends(segment)[1] == site;
  }
  LatticeSite site(std::int32_t number) const {
    if (is_point(number)) return {point(number), point(number)};
    return {point(ends(number)[0]), point(ends(number)[1])};
  }
  std::span<const std::int32_t> ring(std::size_t vertex) const {
    const auto start = static_cast<std::size_t>(vertex_start[vertex]);
    return vertex_sites.subspan(start, static_cast<std::size_t>(vertex_start[vertex + 1]) - start);
  }
};

// The relative errors that values may have: of radii, and of coordinates by the largest of both and the
// radius. That is what the engine proves of its values (core/polished_disc.hpp); none was found to be
// off by more than four ulp.
inline constexpr double value_error_bound = 0x1p-48;

// What is wrong, in words: the first fault of the first check that fails. Nothing if the arrays are the
// Voronoi diagram of the sites, its values right to `value_error_bound`.
//
// That points are distinct is checked; that segments do not cross and hold no point inside is taken for
// granted.
std::optional<std::string> find_fault(const SegmentVoronoiArrays& arrays, unsigned threads,
                                      const Monitor& monitor);

}  // namespace vorotool::core
