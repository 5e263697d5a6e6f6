// A skeleton as its arrays have it, in input units.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/indices.hpp"
#include "core/skeleton/bisector_arc.hpp"

namespace vorotool::core::skeleton {

struct SkeletonView {
  std::span<const kernel::Point> vertices;  // [v]
  std::span<const double> radius;           // [v]
  std::span<const base::IndexPair> arcs;    // [a] source and target
  std::span<const kernel::Point> control;   // [a] NaN on straight lines
  std::span<const base::IndexPair> sites;   // [a] left and right
  std::span<const double> length;           // [a]
  // [s] twice the same: a point; none where none is looked at
  std::span<const std::array<kernel::Point, 2>> site_ends;
  std::span<const std::uint8_t> is_anchored;  // [v] ends that are no leaves: cut off by a frame
  bool has_gap;                               // sites are closed: an end of one may be what is near
  double reach;  // largest magnitude of a coordinate, of the whole if this is a part of a skeleton

  const kernel::Point& source(std::size_t arc) const {
    return vertices[static_cast<std::size_t>(arcs[arc][0])];
  }
  const kernel::Point& target(std::size_t arc) const {
    return vertices[static_cast<std::size_t>(arcs[arc][1])];
  }
  double source_radius(std::size_t arc) const { return radius[static_cast<std::size_t>(arcs[arc][0])]; }
  double target_radius(std::size_t arc) const { return radius[static_cast<std::size_t>(arcs[arc][1])]; }
  bool is_curved(std::size_t arc) const { return control[arc].x == control[arc].x; }
};

}  // namespace vorotool::core::skeleton
