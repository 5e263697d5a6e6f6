// An exact check of a planar straight-line graph that knows its arrays only, not how they were made.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/base/monitor.hpp"
#include "core/kernel/lattice.hpp"

namespace vorotool::core::arrangement {

struct GraphArrays {
  std::span<const kernel::LatticePoint> points;  // [n]
  std::span<const std::int32_t> segments;        // [2 m] ends
  std::span<const std::int32_t> faces;           // [2 m] left and right of each segment; empty: not checked
};

// What is wrong, in words: the first fault of the first check that fails. Nothing if the points are distinct
// and within the lattice, the ends of segments are different points, no two segments have both ends in
// common, no point lies inside a segment, no two segments cross, and the faces are the same around every
// corner and different between faces that have nothing in common.
std::optional<std::string> find_fault(const GraphArrays& graph, const base::Monitor& monitor);

}  // namespace vorotool::core::arrangement
