#include "core/arrangement/snap_rounding.hpp"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <utility>

#include "core/arrangement/hot_pixel_tree.hpp"

namespace vorotool::core::arrangement {

using base::Monitor;
using kernel::LatticePoint;

namespace {

// Disturbances reach farther than that only in inputs made for it, and each round looks at all segments.
constexpr int most_rounds = 16;
constexpr std::size_t segments_between_polls = 4096;

class Snapping {
 public:
  Snapping(const SortedSegments& segments, const SweepResult& swept, const Monitor& monitor)
      : segments_(segments),
        monitor_(monitor),
        nodes_(segments.points.begin(), segments.points.end()),
        met_(segments.lower_end.size()) {
    result_.is_loose.assign(segments.lower_end.size(), 0);
    add_crossings(swept);
  }

  SnappedSegments run(const SweepResult& swept) {
    release_crossing(swept);
    if (!loose_.empty()) {
      const HotPixelTree tree(nodes_);
      std::vector<std::int32_t> disturbed = route(tree, loose_);
      for (int round = 0; !disturbed.empty(); ++round) {
        disturbed = route(tree, round < most_rounds ? release_at(disturbed) : release_all());
      }
    }
    for (const Meeting& meeting : swept.meetings) {
      if (!is_loose(meeting.segment)) met_of(meeting.segment).push_back(node_of_place(meeting.place));
    }
    write_chains();
    return std::move(result_);
  }

 private:
  std::vector<std::int32_t>& met_of(std::int32_t segment) { return met_[static_cast<std::size_t>(segment)]; }
  bool is_loose(std::int32_t segment) const {
    return result_.is_loose[static_cast<std::size_t>(segment)] != 0;
  }
  LatticePoint node(std::int32_t i) const { return nodes_[static_cast<std::size_t>(i)]; }

  std::int32_t node_of_place(std::int32_t place) const {
    const auto points = static_cast<std::int32_t>(segments_.points.size());
    return place < points ? place : node_of_crossing_[static_cast<std::size_t>(place - points)];
  }

  void poll(std::size_t done, std::size_t all) const {
    if (done % segments_between_polls == 0)
      base::report(monitor_, static_cast<double>(done) / static_cast<double>(all));
  }

  // Rounded crossings become nodes, unless there is one.
  void add_crossings(const SweepResult& swept) {
    const std::span<const LatticePoint> points = segments_.points;
    std::vector<LatticePoint>& fresh = result_.new_points;
    for (const RationalPoint& crossing : swept.crossings) fresh.push_back(crossing.nearest());
    std::sort(fresh.begin(), fresh.end(), kernel::lexicographic_less<LatticePoint>);
    fresh.erase(std::unique(fresh.begin(), fresh.end()), fresh.end());
    std::erase_if(fresh, [&](LatticePoint p) {
      return std::binary_search(points.begin(), points.end(), p, kernel::lexicographic_less<LatticePoint>);
    });
    nodes_.insert(nodes_.end(), fresh.begin(), fresh.end());
    for (const RationalPoint& crossing : swept.crossings) {
      const LatticePoint at = crossing.nearest();
      const auto known =
          std::lower_bound(points.begin(), points.end(), at, kernel::lexicographic_less<LatticePoint>);
      const bool is_point = known != points.end() && *known == at;
      const auto place = is_point ? known - points.begin()
                                  : std::lower_bound(fresh.begin(), fresh.end(), at,
                                                     kernel::lexicographic_less<LatticePoint>) -
                                        fresh.begin() + static_cast<std::ptrdiff_t>(points.size());
      node_of_crossing_.push_back(static_cast<std::int32_t>(place));
    }
  }

  void release(std::int32_t segment) {
    result_.is_loose[static_cast<std::size_t>(segment)] = 1;
    loose_.push_back(segment);
  }

  // Makes the segments loose that cross where there is no lattice point.
  void release_crossing(const SweepResult& swept) {
    const auto points = static_cast<std::int32_t>(segments_.points.size());
    for (const Meeting& meeting : swept.meetings) {
      if (meeting.place < points || is_loose(meeting.segment)) continue;
      const RationalPoint& at = swept.crossings[static_cast<std::size_t>(meeting.place - points)];
      if (!at.is_lattice_point()) release(meeting.segment);
    }
  }

  // Finds the nodes whose cells newly loose segments meet; returns those that become disturbed by it.
  std::vector<std::int32_t> route(const HotPixelTree& tree, const std::vector<std::int32_t>& loose) {
    std::vector<std::int32_t> fresh;
    disturbed_.resize(nodes_.size());
    for (std::size_t i = 0; i < loose.size(); ++i) {
      const LatticeSegment segment = segments_.segment(loose[i]);
      tree.visit_met(segment, [&](std::int32_t met) {
        met_of(loose[i]).push_back(met);
        if (side_of(segment, node(met)) != 0 && disturbed_[static_cast<std::size_t>(met)] == 0) {
          disturbed_[static_cast<std::size_t>(met)] = 1;
          fresh.push_back(met);
        }
        return true;
      });
      poll(i, loose.size());
    }
    return fresh;
  }

  // Makes the segments loose that meet one of these cells; returns them.
  std::vector<std::int32_t> release_at(const std::vector<std::int32_t>& disturbed) {
    std::vector<LatticePoint> cells;
    for (const std::int32_t i : disturbed) cells.push_back(node(i));
    const HotPixelTree tree(cells);
    const std::size_t before = loose_.size();
    for (std::size_t s = 0; s < segments_.lower_end.size(); ++s) {
      const auto segment = static_cast<std::int32_t>(s);
      if (is_loose(segment)) continue;
      bool meets = false;
      tree.visit_met(segments_.segment(segment), [&meets](std::int32_t) { return !(meets = true); });
      if (meets) release(segment);
      poll(s, segments_.lower_end.size());
    }
    return {loose_.begin() + static_cast<std::ptrdiff_t>(before), loose_.end()};
  }

  std::vector<std::int32_t> release_all() {
    const std::size_t before = loose_.size();
    for (std::size_t s = 0; s < segments_.lower_end.size(); ++s) {
      if (!is_loose(static_cast<std::int32_t>(s))) release(static_cast<std::int32_t>(s));
    }
    return {loose_.begin() + static_cast<std::ptrdiff_t>(before), loose_.end()};
  }

  // A segment meets cells in the order in which their centers lie along it: both coordinates are monotone.
  void write_chains() {
    result_.chain_start.reserve(met_.size() + 1);
    result_.chain_start.push_back(0);
    for (std::size_t s = 0; s < met_.size(); ++s) {
      std::vector<std::int32_t>& chain = met_[s];
      chain.push_back(segments_.lower_end[s]);
      chain.push_back(segments_.upper_end[s]);
      const bool falls = node(segments_.upper_end[s]).y < node(segments_.lower_end[s]).y;
      std::sort(chain.begin(), chain.end(), [&](std::int32_t i, std::int32_t j) {
        const LatticePoint a = node(i), b = node(j);
        return a.x != b.x ? a.x < b.x : falls ? a.y > b.y : a.y < b.y;
      });
      chain.erase(std::unique(chain.begin(), chain.end()), chain.end());
      result_.chain.insert(result_.chain.end(), chain.begin(), chain.end());
      if (result_.chain.size() > INT32_MAX) throw TooManyCrossings();
      result_.chain_start.push_back(static_cast<std::int32_t>(result_.chain.size()));
      std::vector<std::int32_t>().swap(chain);
    }
  }

  const SortedSegments& segments_;
  const Monitor& monitor_;
  std::vector<LatticePoint> nodes_;  // the points of the input, then the new ones
  std::vector<std::int32_t> node_of_crossing_;
  std::vector<std::int32_t> loose_;
  std::vector<std::uint8_t> disturbed_;
  std::vector<std::vector<std::int32_t>> met_;  // nodes on each segment's way, in no order
  SnappedSegments result_;
};

}  // namespace

SnappedSegments snap_segments(const SortedSegments& segments, const SweepResult& swept,
                              const Monitor& monitor) {
  return Snapping(segments, swept, monitor).run(swept);
}

}  // namespace vorotool::core::arrangement
