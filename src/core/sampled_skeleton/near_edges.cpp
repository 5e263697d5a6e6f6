#include "core/sampled_skeleton/near_edges.hpp"

#include <utility>

#include "core/base/indices.hpp"
#include "core/numbers/elementary.hpp"
#include "core/spatial/clearance.hpp"

namespace vorotool::core::sampled_skeleton {

using kernel::Point;

namespace {

constexpr double distance_error = 0x1p-18;  // of places and distances below 2^32 steps
constexpr double wider = 0x1p-5;            // part of its radius by which a disc is widened

}  // namespace

std::vector<std::vector<NearEdge>> NearEdges::items(const kernel::PlanarGraphView& graph,
                                                    const SampleGroups& groups) {
  std::vector<std::vector<NearEdge>> all(static_cast<std::size_t>(groups.count));
  const auto of_point = [&](std::size_t i) {
    return groups.of_point.empty() ? 0 : static_cast<std::size_t>(groups.of_point[i]);
  };
  std::vector<bool> is_end(graph.points.size());
  for (std::size_t j = 0; j < graph.segments.size(); ++j) {
    const auto segment = static_cast<std::int32_t>(j);
    all[base::at(groups.of_segment(graph, segment))].push_back({segment, graph.segment(j)});
    for (const std::int32_t end : graph.segments[j]) is_end[static_cast<std::size_t>(end)] = true;
  }
  for (std::size_t i = 0; i < graph.points.size(); ++i) {
    if (!is_end[i]) all[of_point(i)].push_back({-1, {graph.points[i], graph.points[i]}});
  }
  return all;
}

std::optional<std::span<const NearEdge>> NearEdges::find(const DiscPair& discs) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (!is_known(discs.center[i], discs.radius[i], i)) search(discs.center[i], discs.radius[i], discs_[i]);
  }
  if (is_crowded(0) || is_crowded(1)) return {};
  found_.clear();
  const auto& [first, second] = discs_;
  for (const std::uint32_t number : first.numbers) found_.push_back(items_[number]);
  for (const std::uint32_t number : second.numbers) {
    const bool is_new = std::find(first.numbers.begin(), first.numbers.end(), number) == first.numbers.end();
    if (is_new) found_.push_back(items_[number]);
  }
  return found_;
}

// Whether disc i is one of the last two, in its place now.
bool NearEdges::is_known(const Point& center, double radius, std::size_t i) {
  const auto is = [&](const Found& found) { return found.center == center && found.radius == radius; };
  if (is(discs_[i])) return true;
  if (i == 1 || !is(discs_[1])) return false;
  std::swap(discs_[0], discs_[1]);
  return true;
}

void NearEdges::search(const Point& center, double radius, Found& found) {
  found.center = center;
  found.radius = radius;
  found.numbers.clear();
  const double reach = radius + distance_error;
  const auto visit = [&](std::uint32_t number) {
    if (spatial::closed_distance(items_[number].site, center) <= reach) found.numbers.push_back(number);
    return found.numbers.size() <= most_;
  };
  if (!is_surrounded(center, reach)) {
    hierarchy_.near(center.x, center.y, reach, visit);
    return;
  }
  for (const std::uint32_t number : surroundings_.numbers) {  // in the order of the hierarchy as well
    if (!visit(number)) return;
  }
}

bool NearEdges::is_surrounded(const Point& center, double reach) {
  const auto away = [&](const Point& p) { return distance(p, center); };
  const double moved = away(last_);
  last_ = center;
  Found& found = surroundings_;
  if (away(found.center) + reach + distance_error > found.radius) {
    if (moved > wider / 8 * reach) return false;
    found.center = center;
    found.radius = reach * (1 + wider);
    found.numbers.clear();
    hierarchy_.near(center.x, center.y, found.radius, [&](std::uint32_t number) {
      if (spatial::closed_distance(items_[number].site, center) <= found.radius + distance_error)
        found.numbers.push_back(number);
      return found.numbers.size() <= 2 * most_;
    });
  }
  return found.numbers.size() <= 2 * most_;
}

}  // namespace vorotool::core::sampled_skeleton
