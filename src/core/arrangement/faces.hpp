// The faces into which segments divide the plane.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/arrangement/segment_intersections.hpp"

namespace vorotool::core::arrangement {

struct Faces {
  std::vector<std::int32_t> left, right;  // [m] face on each side of a segment, seen from its lower end
  std::int32_t count = 1;                 // face 0 is the unbounded one
};

// The segments must meet at common ends only, and `below` be that of their sweep.
Faces find_faces(const SortedSegments& segments, std::span<const std::int32_t> below);

}  // namespace vorotool::core::arrangement
