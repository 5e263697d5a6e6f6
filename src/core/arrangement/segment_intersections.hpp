// All places where lattice segments meet other than at common ends, by a plane sweep in exact arithmetic.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "core/arrangement/rational_point.hpp"
#include "core/base/monitor.hpp"

namespace vorotool::core::arrangement {

// More meetings than their numbers, and memory, allow.
struct TooManyCrossings : std::length_error {
  TooManyCrossings() : std::length_error("the segments cross each other too often") {}
};

// Segments between points that are distinct and sorted (is_before). Each has its lower end first, and no two
// have both ends in common. They are sorted by their lower end; those of one lower end by slope from the
// lowest, of equal slope the shorter first.
struct SortedSegments {
  std::span<const kernel::LatticePoint> points;  // [n]
  std::span<const std::int32_t> start;           // [n + 1] first segment with each point as its lower end
  std::span<const std::int32_t> upper_end;       // [m]
  std::span<const std::int32_t> lower_end;       // [m]

  LatticeSegment segment(std::int32_t s) const {
    const auto i = static_cast<std::size_t>(s);
    return {points[static_cast<std::size_t>(lower_end[i])], points[static_cast<std::size_t>(upper_end[i])]};
  }
};

// A place inside a segment: a point of the input (below n), or crossing `place - n`.
struct Meeting {
  std::int32_t segment, place;
};

struct SweepResult {
  // Of two segments or more inside them, none a point of the input; sorted
  std::vector<RationalPoint> crossings;
  // Every place inside a segment that is a point or on another segment; by place
  std::vector<Meeting> meetings;
  // [n] for a point that no segment ends at or passes through from the left: the segment next below it, -1 if
  // there is none. -1 also for other points.
  std::vector<std::int32_t> below;
};

// Sweeps as Bentley and Ottmann (1979), all segments through one place taken together. O((m + k) log m) for k
// meetings. Segments that overlap meet at the ends of the shorter one; nothing is said of the stretch
// between.
SweepResult sweep_segments(const SortedSegments& segments, const base::Monitor& monitor);

}  // namespace vorotool::core::arrangement
