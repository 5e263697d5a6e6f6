#include "core/graphs/shortest_paths.hpp"

#include <algorithm>
#include <cmath>

namespace vorotool::core::graphs {

using base::at;

namespace {

bool is_farther(const ShortestPaths::Start& a, const ShortestPaths::Start& b) {
  return a.distance != b.distance ? a.distance > b.distance : a.node > b.node;
}

}  // namespace

std::vector<std::int64_t> whole_lengths(std::span<const double> lengths, std::span<const std::int32_t> group,
                                        std::size_t groups) {
  std::vector<double> sum(groups);
  for (std::size_t k = 0; k < lengths.size(); ++k) sum[at(group[k])] += lengths[k];
  std::vector<int> exponent(groups);
  for (std::size_t k = 0; k < groups; ++k) std::frexp(sum[k], &exponent[k]);  // the sum is below 2^exponent
  std::vector<std::int64_t> whole(lengths.size());
  for (std::size_t k = 0; k < lengths.size(); ++k) {
    const double scaled = std::ldexp(lengths[k], 61 - exponent[at(group[k])]);
    whole[k] = static_cast<std::int64_t>(std::floor(scaled + 0.5));
  }
  return whole;
}

GraphIncidence arcs_at_nodes(std::span<const base::IndexPair> arcs, std::size_t nodes,
                             const std::vector<bool>& uses) {
  return {nodes, [&](const auto& add) {
            for (std::size_t k = 0; k < arcs.size(); ++k) {
              if (!uses.empty() && !uses[k]) continue;
              for (const std::int32_t node : arcs[k]) add(node, static_cast<std::int32_t>(k));
            }
          }};
}

ShortestPaths::ShortestPaths(std::span<const base::IndexPair> arcs, std::span<const std::int64_t> lengths,
                             const GraphIncidence& incidence, std::size_t nodes)
    : arcs_(arcs), lengths_(lengths), incidence_(incidence), distance_(nodes, unreached), last_(nodes, -1) {}

void ShortestPaths::find(std::span<const Start> starts, const base::Monitor& monitor) {
  for (const std::int32_t node : reached_) distance_[at(node)] = unreached;
  reached_.clear();
  for (const auto& [node, distance] : starts) reach(node, distance, -1);
  std::size_t done = 0;
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end(), is_farther);
    const auto [node, distance] = queue_.back();
    queue_.pop_back();
    if (distance > distance_[at(node)]) continue;
    if (++done % (1 << 14) == 0) base::report(monitor, 0);
    for (const std::int32_t arc : incidence_[node]) {
      const auto [a, b] = arcs_[at(arc)];
      reach(a == node ? b : a, distance + lengths_[at(arc)], arc);
    }
  }
}

// An arc of length 0 takes no node over: two such could lead to each other.
void ShortestPaths::reach(std::int32_t node, std::int64_t distance, std::int32_t arc) {
  std::int64_t& best = distance_[at(node)];
  if (best == distance) {
    if (last_[at(node)] > arc && arc >= 0 && lengths_[at(arc)] > 0) last_[at(node)] = arc;
    return;
  }
  if (best != unreached && best < distance) return;
  if (best == unreached) reached_.push_back(node);
  best = distance;
  last_[at(node)] = arc;
  queue_.push_back({node, distance});
  std::push_heap(queue_.begin(), queue_.end(), is_farther);
}

GraphPath ShortestPaths::path_to(std::int32_t node) const {
  GraphPath path;
  if (distance(node) == unreached) return path;
  path.nodes.push_back(node);
  while (last_[at(node)] >= 0) {
    const std::int32_t arc = last_[at(node)];
    const auto [a, b] = arcs_[at(arc)];
    node = a == node ? b : a;
    path.arcs.push_back(arc);
    path.nodes.push_back(node);
  }
  std::reverse(path.nodes.begin(), path.nodes.end());
  std::reverse(path.arcs.begin(), path.arcs.end());
  return path;
}

}  // namespace vorotool::core::graphs
