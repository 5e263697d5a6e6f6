// A skeleton as its arrays have it, in input units.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/skeleton/bisector_arc.hpp"

namespace vorotool::core::skeleton {

struct SkeletonView {
  std::span<const Place> vertices;                     // [v]
  std::span<const double> radius;                      // [v]
  std::span<const std::array<std::int32_t, 2>> arcs;   // [a] source and target
  std::span<const Place> control;                      // [a] NaN on straight lines
  std::span<const std::array<std::int32_t, 2>> sites;  // [a] left and right
  std::span<const double> length;                      // [a]
  // [s] twice the same: a point; none where none is looked at
  std::span<const std::array<Place, 2>> site_ends;
  std::span<const std::uint8_t> is_anchored;  // [v] ends that are no leaves: cut off by a frame
  bool has_gap;                               // sites are closed: an end of one may be what is near
  double reach;  // largest magnitude of a coordinate, of the whole if this is a part of a skeleton

  const Place& source(std::size_t arc) const { return vertices[static_cast<std::size_t>(arcs[arc][0])]; }
  const Place& target(std::size_t arc) const { return vertices[static_cast<std::size_t>(arcs[arc][1])]; }
  double source_radius(std::size_t arc) const { return radius[static_cast<std::size_t>(arcs[arc][0])]; }
  double target_radius(std::size_t arc) const { return radius[static_cast<std::size_t>(arcs[arc][1])]; }
  bool is_curved(std::size_t arc) const { return control[arc][0] == control[arc][0]; }
};

}  // namespace vorotool::core::skeleton
