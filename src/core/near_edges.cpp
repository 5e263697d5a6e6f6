#include "core/near_edges.hpp"

#include "core/clearance.hpp"

namespace vorotool::core {
namespace {

constexpr double distance_error = 0x1p-18;  // of places and distances below 2^32 steps

}  // namespace

std::vector<NearEdge> NearEdges::items(const ShapeGraph& graph) {
  std::vector<NearEdge> all;
  std::vector<bool> is_end(graph.points.size());
  for (std::size_t j = 0; j < graph.segments.size(); ++j) {
    all.push_back({static_cast<std::int32_t>(j), graph.site(static_cast<std::int32_t>(j))});
    for (const std::int32_t end : graph.segments[j]) is_end[static_cast<std::size_t>(end)] = true;
  }
  for (std::size_t i = 0; i < graph.points.size(); ++i) {
    if (!is_end[i]) all.push_back({-1, {graph.points[i], graph.points[i]}});
  }
  return all;
}

std::optional<std::span<const NearEdge>> NearEdges::find(const DiscPair& discs) {
  found_.clear();
  numbers_.clear();
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& [x, y] = discs.centre[i];
    const double reach = discs.radius[i] + distance_error;
    hierarchy_.near(x, y, reach, [&](std::uint32_t number) {
      if (closed_distance(items_[number].site, discs.centre[i]) > reach) return true;
      if (std::find(numbers_.begin(), numbers_.end(), number) != numbers_.end()) return true;
      numbers_.push_back(number);
      found_.push_back(items_[number]);
      return found_.size() <= most;
    });
    if (found_.size() > most) return {};
  }
  return found_;
}

}  // namespace vorotool::core
