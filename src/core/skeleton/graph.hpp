// A skeleton while it is put together: arcs between nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/segment_voronoi/build/diagram.hpp"
#include "core/skeleton/bisector_arc.hpp"

namespace vorotool::core::skeleton {

// Sides of a frame, in the order in which cuts name them.
enum class FrameSide : std::int8_t { none = -1, least_x, most_x, least_y, most_y };

struct GraphArc {
  std::int32_t source, target;  // nodes; -1: at infinity
  std::int32_t left, right;     // sites, seen from source to target
  std::int32_t group;           // arcs of one group stay together
};

// Node i below the number of vertices is vertex i of the diagram; others are corners, one for each arc that
// ends there, and ends on a frame.
class SkeletonGraph {
 public:
  SkeletonGraph(const segment_voronoi::build::DiagramView& diagram, std::span<const std::int32_t> edges,
                std::span<const std::int32_t> groups);

  const segment_voronoi::build::DiagramView& diagram() const { return diagram_; }
  std::size_t node_count() const { return diagram_.radius.size() + extra_.size(); }

  ArcEnd end(std::int32_t node) const {
    const auto i = static_cast<std::size_t>(node), count = diagram_.radius.size();
    return i < count ? ArcEnd{diagram_.vertices[i], diagram_.radius[i]} : extra_[i - count].end;
  }
  FrameSide side(std::int32_t node) const {
    const auto i = static_cast<std::size_t>(node), count = diagram_.radius.size();
    return i < count ? FrameSide::none : extra_[i - count].side;
  }
  BisectorArc bisector(const GraphArc& arc) const {
    return {diagram_.site(arc.left), diagram_.site(arc.right)};
  }

  // Gives one node to the corners at one place where arcs of one group end, for groups from `first` to before
  // `last`.
  void join_corners(std::int32_t first, std::int32_t last);

  // Gives the number of a new node.
  std::int32_t add_node(const ArcEnd& end, FrameSide side);

  std::vector<GraphArc> arcs;

 private:
  struct ExtraNode {
    ArcEnd end;
    FrameSide side;
  };

  // Different sectors of a corner have nothing in common but the corner: each arc gets its own node there.
  std::int32_t node_at(std::int32_t vertex);

  const segment_voronoi::build::DiagramView& diagram_;
  std::vector<ExtraNode> extra_;
};

}  // namespace vorotool::core::skeleton
