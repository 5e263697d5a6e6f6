#include "core/arrangement/boundary_rings.hpp"

#include <algorithm>
#include <tuple>

#include "core/arrangement/rational_point.hpp"
#include "core/base/disjoint_sets.hpp"
#include "core/base/indices.hpp"
#include "core/numbers/int128.hpp"

namespace vorotool::core::arrangement {

using base::at;
using kernel::LatticePoint;
using kernel::PlanarGraphView;

namespace {

// A side of a segment on which a polygon is, and across it is not; directed with the polygon on the left.
// `region` is any entry of the region there, as DisjointSets has them.
struct Border {
  std::int32_t polygon, from, to, segment, region;
};

struct Ring {
  std::int32_t polygon, region;
  bool is_hole;
  std::vector<std::int32_t> borders;  // from the one that leaves the first point
  std::int32_t first_point, shell_point;
};

class Tracer {
 public:
  // A region of a polygon is a set of entries of face_polygon: its faces, joined where a segment divides two.
  Tracer(const PlanarGraphView& graph, std::span<const std::int32_t> face_start,
         std::span<const std::int32_t> face_polygon)
      : graph_(graph), face_start_(face_start), face_polygon_(face_polygon), regions_(face_polygon.size()) {
    for (std::size_t s = 0; s < graph.segments.size(); ++s) compare_sides(s);
    std::sort(borders_.begin(), borders_.end(), [](const Border& a, const Border& b) {
      return std::tie(a.polygon, a.from, a.segment) < std::tie(b.polygon, b.from, b.segment);
    });
    is_used_.assign(borders_.size(), 0);
    place_.assign(graph.points.size(), -1);
  }

  std::vector<Ring> trace() {
    for (std::size_t i = 0; i < borders_.size(); ++i) {
      if (is_used_[i] == 0) walk(static_cast<std::int32_t>(i));
    }
    return std::move(rings_);
  }

  const Border& border(std::int32_t i) const { return borders_[at(i)]; }

 private:
  void compare_sides(std::size_t s) {
    const std::size_t left = at(graph_.faces[s][0]), right = at(graph_.faces[s][1]);
    const auto [a, b] = graph_.segments[s];
    const auto segment = static_cast<std::int32_t>(s);
    std::int32_t l = face_start_[left], r = face_start_[right];
    const std::int32_t l_end = face_start_[left + 1], r_end = face_start_[right + 1];
    while (l < l_end || r < r_end) {
      const std::int32_t lp = l < l_end ? polygon(l) : INT32_MAX, rp = r < r_end ? polygon(r) : INT32_MAX;
      if (lp == rp) {
        regions_.join(l++, r++);
      } else if (lp < rp) {
        borders_.push_back({lp, a, b, segment, l++});
      } else {
        borders_.push_back({rp, b, a, segment, r++});
      }
    }
  }

  std::int32_t polygon(std::int32_t entry) const { return face_polygon_[at(entry)]; }

  // The border that goes on around the same sector of the polygon: from the end, clockwise next to the way
  // back.
  std::int32_t next(std::int32_t i) const {
    const Border& here = border(i);
    const auto is_before = [](const Border& a, const Border& b) {
      return std::tie(a.polygon, a.from) < std::tie(b.polygon, b.from);
    };
    const Border wanted{here.polygon, here.to, 0, 0, 0};
    const auto [begin, end] = std::equal_range(borders_.begin(), borders_.end(), wanted, is_before);
    auto best = begin;
    for (auto other = begin; other != end; ++other) {
      if (is_clockwise_first(graph_.point(here.to), graph_.point(here.from), graph_.point(other->to),
                             graph_.point(best->to)))
        best = other;
    }
    return static_cast<std::int32_t>(best - borders_.begin());
  }

  // Whether a turn clockwise around a center, from the direction of `start`, reaches a before b. The way back
  // itself, if it is one, comes last.
  static bool is_clockwise_first(LatticePoint center, LatticePoint start, LatticePoint a, LatticePoint b) {
    const auto half = [&](LatticePoint p) {  // 0 within the half turn clockwise, 1 beyond; start is beyond
      const std::int64_t area = turn(center, start, p);
      if (area != 0) return area < 0 ? 0 : 1;
      const bool is_opposite =
          (start.x < center.x) != (p.x < center.x) || (start.y < center.y) != (p.y < center.y);
      return is_opposite ? 0 : 2;
    };
    if (half(a) != half(b)) return half(a) < half(b);
    return turn(center, b, a) > 0;
  }

  // Follows borders until they close, and takes a ring off wherever a point is visited again.
  void walk(std::int32_t i) {
    while (is_used_[at(i)] == 0) {
      is_used_[at(i)] = 1;
      place_[at(border(i).from)] = static_cast<std::int32_t>(path_.size());
      path_.push_back(i);
      if (const std::int32_t seen = place_[at(border(i).to)]; seen >= 0) take_ring(seen);
      i = next(i);
    }
  }

  void take_ring(std::int32_t from) {
    const auto begin = path_.begin() + from;
    Ring ring{
        border(*begin).polygon, regions_.find(border(*begin).region), false, {begin, path_.end()}, -1, -1};
    path_.erase(begin, path_.end());
    numbers::int128 area = 0;  // at most 2^31 terms below 2^63
    for (const std::int32_t i : ring.borders) {
      const LatticePoint a = graph_.point(border(i).from), b = graph_.point(border(i).to);
      area += std::int64_t{a.x} * b.y - std::int64_t{a.y} * b.x;
      place_[at(border(i).from)] = -1;
    }
    ring.is_hole = area < 0;
    const auto first = std::min_element(ring.borders.begin(), ring.borders.end(),
                                        [this](auto a, auto b) { return border(a).from < border(b).from; });
    std::rotate(ring.borders.begin(), first, ring.borders.end());
    ring.first_point = border(ring.borders.front()).from;
    rings_.push_back(std::move(ring));
  }

  const PlanarGraphView& graph_;
  std::span<const std::int32_t> face_start_, face_polygon_;
  base::DisjointSets<std::int32_t> regions_;
  std::vector<Border> borders_;  // sorted by polygon and then by their first points
  std::vector<std::uint8_t> is_used_;
  std::vector<std::int32_t> place_;  // of each point in the path, or -1
  std::vector<std::int32_t> path_;
  std::vector<Ring> rings_;
};

// Each region has one shell: holes come after it.
void sort_rings(std::vector<Ring>& rings, std::size_t regions) {
  std::vector<std::int32_t> shell_point(regions, -1);
  for (const Ring& ring : rings) {
    if (!ring.is_hole) shell_point[at(ring.region)] = ring.first_point;
  }
  for (Ring& ring : rings) ring.shell_point = shell_point[at(ring.region)];
  std::sort(rings.begin(), rings.end(), [](const Ring& a, const Ring& b) {
    return std::tie(a.polygon, a.shell_point, a.region, a.is_hole, a.first_point, a.borders) <
           std::tie(b.polygon, b.shell_point, b.region, b.is_hole, b.first_point, b.borders);
  });
}

}  // namespace

BoundaryRings find_boundary_rings(const PlanarGraphView& graph, std::span<const std::int32_t> face_start,
                                  std::span<const std::int32_t> face_polygon) {
  Tracer tracer(graph, face_start, face_polygon);
  std::vector<Ring> rings = tracer.trace();
  sort_rings(rings, face_polygon.size());
  BoundaryRings result;
  result.start.push_back(0);
  for (const Ring& ring : rings) {
    if (!ring.is_hole) result.part_polygon.push_back(ring.polygon);
    result.is_hole.push_back(ring.is_hole ? 1 : 0);
    result.ring_part.push_back(static_cast<std::int32_t>(result.part_polygon.size()) - 1);
    for (const std::int32_t i : ring.borders) {
      result.point.push_back(tracer.border(i).from);
      result.segment.push_back(tracer.border(i).segment);
    }
    result.start.push_back(static_cast<std::int32_t>(result.point.size()));
  }
  return result;
}

}  // namespace vorotool::core::arrangement
