#include "core/offsets/level_crossings.hpp"

#include <algorithm>
#include <tuple>

#include "core/base/indices.hpp"
#include "core/graphs/biconnected_components.hpp"

namespace vorotool::core::offsets {

LevelCrossings::LevelCrossings(const HalfEdges& borders, const PolygonFaces& domain, const LevelSet& level,
                               OuterComponents& far, const base::Monitor& monitor)
    : borders_(borders), number_(static_cast<std::size_t>(borders.size()), -1) {
  for (HalfEdge h = 0; h < borders.size(); ++h) {
    base::report_item(monitor, static_cast<std::size_t>(h));
    if (!level.descends(h) || !domain.holds(borders, h)) continue;
    number_[static_cast<std::size_t>(h)] = static_cast<std::int32_t>(all_.size());
    all_.push_back(h);
    places_.push_back(level.crossing(h));
  }
  onward_ = all_;
  part_touching(level, far, domain.is_outward);
}

// Back up the edge, and around the cell through what is far to the first half-edge that descends.
HalfEdge LevelCrossings::across_cell(HalfEdge h) const {
  h ^= 1;
  do {
    h = borders_.next(h);
  } while (!has(h));
  return h;
}

namespace {

// A corner of a region of what is far: at a vertex on the level, or in the middle of an edge that touches it.
struct Corner {
  std::int32_t place, group;
  std::size_t rank;  // counter-clockwise around the place
  std::int32_t region;
  HalfEdge half_edge;

  friend bool operator<(const Corner& a, const Corner& b) {
    return std::tie(a.place, a.group, a.rank) < std::tie(b.place, b.group, b.rank);
  }
};

// Numbers places and regions one after the other, and gives corners that are on one cycle the same group.
void group_by_cycles(std::vector<Corner>& corners) {
  std::vector<std::int32_t> regions;
  for (const Corner& corner : corners) regions.push_back(corner.region);
  std::sort(regions.begin(), regions.end());
  regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
  std::vector<base::IndexPair> pairs;
  auto nodes = static_cast<std::int32_t>(regions.size());
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (k > 0 && corners[k].place != corners[k - 1].place) ++nodes;
    const auto region = std::lower_bound(regions.begin(), regions.end(), corners[k].region) - regions.begin();
    pairs.push_back({static_cast<std::int32_t>(region), nodes});
  }
  const std::vector<std::int32_t> component =
      graphs::biconnected_components(static_cast<std::size_t>(nodes) + 1, pairs);
  for (std::size_t k = 0; k < corners.size(); ++k) corners[k].group = component[k];
}

}  // namespace

// A region may have several corners at one place. What is near falls apart there between them: the parts have
// only that place in common. So the curve goes on from the corner before, clockwise, of the same region, and
// no curve visits a place twice. Between corners of different regions what is near is connected; but shapes
// of it fall apart also where several such places together divide them, which is where regions and places are
// on a cycle.
void LevelCrossings::part_touching(const LevelSet& level, OuterComponents& far, bool shapes_are_near) {
  const auto vertices = static_cast<std::int32_t>(borders_.diagram().radius.size());
  std::vector<Corner> corners;
  for (const HalfEdge h : all_) {
    const std::int32_t region = far.of(borders_.tail(h));
    if (level.ends_at_head(h)) {
      corners.push_back({borders_.head(h), region, borders_.rank_at_tail(h ^ 1), region, h});
    } else if (level.touches(h)) {
      corners.push_back({vertices + (h >> 1), region, static_cast<std::size_t>(h & 1), region, h});
    }
  }
  std::sort(corners.begin(), corners.end());
  if (shapes_are_near) {
    group_by_cycles(corners);
    std::sort(corners.begin(), corners.end());
  }
  for (std::size_t first = 0, last; first < corners.size(); first = last) {
    const auto& [place, group, rank, region, half_edge] = corners[first];
    for (last = first + 1; last < corners.size(); ++last) {
      if (corners[last].place != place || corners[last].group != group) break;
      onward_[number(corners[last].half_edge)] = corners[last - 1].half_edge;
      far.join(region, corners[last].region);
    }
    onward_[number(half_edge)] = corners[last - 1].half_edge;
  }
}

}  // namespace vorotool::core::offsets
