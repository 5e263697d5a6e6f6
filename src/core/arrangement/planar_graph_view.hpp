// Shapes as a planar straight-line graph on the lattice, in flat arrays.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/kernel/lattice.hpp"

namespace vorotool::core::arrangement {

struct PlanarGraphView {
  std::span<const kernel::LatticePoint> points;           // [n] distinct
  std::span<const std::array<std::int32_t, 2>> segments;  // [m] ends; segments meet at ends only
  std::span<const std::array<std::int32_t, 2>> faces;  // [m] left and right of each; 0 is the unbounded one

  const kernel::LatticePoint& point(std::int32_t i) const { return points[static_cast<std::size_t>(i)]; }
  const std::array<std::int32_t, 2>& ends(std::int32_t segment) const {
    return segments[static_cast<std::size_t>(segment)];
  }
  kernel::LatticeSite site(std::int32_t segment) const {
    return {point(ends(segment)[0]), point(ends(segment)[1])};
  }
};

}  // namespace vorotool::core::arrangement
