#include "core/arrangement/faces.hpp"

#include <algorithm>

#include "core/base/disjoint_sets.hpp"
#include "core/base/groups.hpp"

namespace vorotool::core::arrangement {
namespace {

// Half-edge 2 s goes from the lower to the upper end of segment s, 2 s + 1 back.
class Rotation {
 public:
  explicit Rotation(const SortedSegments& segments)
      : around_(segments.points.size(), [&](const auto& add) { visit(segments, add); }),
        place_(2 * segments.lower_end.size()) {
    for (std::size_t i = 0; i < around_.size(); ++i) {
      const std::span<std::int32_t> around = around_[i];
      const auto is_left = [](std::int32_t half_edge) { return (half_edge & 1) != 0; };
      std::sort(std::ranges::find_if(around, is_left), around.end(),
                [&](std::int32_t a, std::int32_t b) { return is_lower(segments, a / 2, b / 2); });
      for (std::size_t k = 0; k < around.size(); ++k) place_[static_cast<std::size_t>(around[k])] = k;
    }
  }

  // The half-edge that follows along the face on the left: clockwise next to the way back, around its source.
  std::int32_t next(const SortedSegments& segments, std::int32_t half_edge) const {
    const std::int32_t back = half_edge ^ 1;
    const auto s = static_cast<std::size_t>(half_edge / 2);
    const std::int32_t point = (half_edge & 1) == 0 ? segments.upper_end[s] : segments.lower_end[s];
    const std::span<const std::int32_t> around = around_[point];
    const std::size_t place = place_[static_cast<std::size_t>(back)];
    return place == 0 ? around.back() : around[place - 1];
  }

 private:
  // To the right from the lowest slope up, then to the left from the highest place down: counter-clockwise,
  // and both by rising slope.
  template <class Add>
  static void visit(const SortedSegments& segments, const Add& add) {
    const auto count = static_cast<std::int32_t>(segments.lower_end.size());
    for (std::int32_t s = 0; s < count; ++s) add(segments.lower_end[static_cast<std::size_t>(s)], 2 * s);
    for (std::int32_t s = 0; s < count; ++s) add(segments.upper_end[static_cast<std::size_t>(s)], 2 * s + 1);
  }

  // Segments with a common upper end do not overlap, so that none has the slope of another.
  static bool is_lower(const SortedSegments& segments, std::int32_t s, std::int32_t t) {
    const LatticeSegment a = segments.segment(s), b = segments.segment(t);
    return turn(a.b, a.a, b.a) > 0;
  }

  base::Groups<std::int32_t> around_;  // half-edges from each point, counter-clockwise
  std::vector<std::size_t> place_;     // of each half-edge among those of its point
};

// The cycle that each half-edge is on; returns their number.
std::int32_t label_cycles(const SortedSegments& segments, std::vector<std::int32_t>& cycle) {
  const Rotation rotation(segments);
  std::int32_t count = 0;
  for (std::size_t h = 0; h < cycle.size(); ++h) {
    if (cycle[h] >= 0) continue;
    auto at = static_cast<std::int32_t>(h);
    while (cycle[static_cast<std::size_t>(at)] < 0) {
      cycle[static_cast<std::size_t>(at)] = count;
      at = rotation.next(segments, at);
    }
    ++count;
  }
  return count;
}

}  // namespace

Faces find_faces(const SortedSegments& segments, std::span<const std::int32_t> below) {
  std::vector<std::int32_t> cycle(2 * segments.lower_end.size(), -1);
  const std::int32_t cycles = label_cycles(segments, cycle);
  // Face of the sets: 0 for outside, cycle + 1 else. Left of a point that nothing comes to from the left is
  // the face left of its highest segment, and the one above the segment next below.
  base::DisjointSets<std::int32_t> faces(static_cast<std::size_t>(cycles) + 1);
  const auto left_of = [&](std::int32_t segment) { return cycle[2 * static_cast<std::size_t>(segment)] + 1; };
  std::vector<std::uint8_t> has_left(segments.points.size(), 0);
  for (const std::int32_t end : segments.upper_end) has_left[static_cast<std::size_t>(end)] = 1;
  for (std::size_t i = 0; i < segments.points.size(); ++i) {
    if (has_left[i] != 0 || segments.start[i] == segments.start[i + 1]) continue;
    faces.join(left_of(segments.start[i + 1] - 1), below[i] < 0 ? 0 : left_of(below[i]));
  }
  Faces result;
  std::vector<std::int32_t> number(static_cast<std::size_t>(cycles) + 1, -1);
  number[0] = 0;
  const auto numbered = [&](std::int32_t half_edge_cycle) {
    std::int32_t& known = number[static_cast<std::size_t>(faces.find(half_edge_cycle + 1))];
    if (known < 0) known = result.count++;
    return known;
  };
  result.left.reserve(segments.lower_end.size());
  result.right.reserve(segments.lower_end.size());
  for (std::size_t s = 0; s < segments.lower_end.size(); ++s) {
    result.left.push_back(numbered(cycle[2 * s]));
    result.right.push_back(numbered(cycle[2 * s + 1]));
  }
  return result;
}

}  // namespace vorotool::core::arrangement
