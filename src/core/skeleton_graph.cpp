#include "core/skeleton_graph.hpp"

namespace vorotool::core {

SkeletonGraph::SkeletonGraph(const SegmentDiagram& diagram, std::span<const std::int32_t> edges,
                             std::span<const std::int32_t> groups)
    : diagram_(diagram) {
  arcs.reserve(edges.size());
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const auto e = static_cast<std::size_t>(edges[k]);
    const auto [source, target] = diagram.edges[e];
    const auto [left, right] = diagram.edge_sites[e];
    arcs.push_back({node_at(source), node_at(target), left, right, groups[k]});
  }
}

std::int32_t SkeletonGraph::node_at(std::int32_t vertex) {
  if (vertex < 0 || diagram_.radius[static_cast<std::size_t>(vertex)] > 0) return vertex;
  return add_node({diagram_.vertices[static_cast<std::size_t>(vertex)], 0}, FrameSide::none);
}

std::int32_t SkeletonGraph::add_node(const ArcEnd& end, FrameSide side) {
  extra_.push_back({end, side});
  return static_cast<std::int32_t>(node_count() - 1);
}

}  // namespace vorotool::core
