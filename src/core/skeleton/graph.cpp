#include "core/skeleton/graph.hpp"

#include <algorithm>
#include <tuple>

namespace vorotool::core::skeleton {

using kernel::Point;

SkeletonGraph::SkeletonGraph(const segment_voronoi::build::DiagramView& diagram,
                             std::span<const std::int32_t> edges, std::span<const std::int32_t> groups)
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

void SkeletonGraph::join_corners(std::int32_t first, std::int32_t last) {
  struct Corner {
    Point place;
    std::int32_t group;
    std::int32_t* node;
  };
  const auto key = [](const Corner& corner) {
    return std::tie(corner.place.x, corner.place.y, corner.group);
  };
  std::vector<Corner> corners;
  for (GraphArc& arc : arcs) {
    if (arc.group < first || arc.group >= last) continue;
    for (std::int32_t* node : {&arc.source, &arc.target}) {
      if (*node >= 0 && end(*node).radius == 0) corners.push_back({end(*node).place, arc.group, node});
    }
  }
  std::sort(corners.begin(), corners.end(), [&](const Corner& a, const Corner& b) {
    return std::tuple_cat(key(a), std::tie(*a.node)) < std::tuple_cat(key(b), std::tie(*b.node));
  });
  for (std::size_t k = 1; k < corners.size(); ++k) {
    if (key(corners[k]) == key(corners[k - 1])) *corners[k].node = *corners[k - 1].node;
  }
}

std::int32_t SkeletonGraph::add_node(const ArcEnd& end, FrameSide side) {
  extra_.push_back({end, side});
  return static_cast<std::int32_t>(node_count() - 1);
}

}  // namespace vorotool::core::skeleton
