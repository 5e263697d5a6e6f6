// Arcs of an approximate skeleton while it is put together: parts of Voronoi edges between nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"
#include "core/sampled_skeleton/corner_bisectors.hpp"
#include "core/sampled_skeleton/sample_diagram.hpp"
#include "core/skeleton/extraction.hpp"
#include "core/skeleton/frame_clip.hpp"
#include "core/skeleton/graph.hpp"

namespace vorotool::core::sampled_skeleton {

// The bisector that an arc is a part of.
struct ArcOrigin {
  Side side;            // of the triangulation; -1: it has no triangles
  std::int32_t corner;  // where a line begins that completes the skeleton; -1 of others
};

class SampleArcs {
 public:
  explicit SampleArcs(const SampleDiagram& diagram) : diagram_(diagram) {}

  // Kept edges, in the groups of their faces; none of a negative group.
  void add_kept(std::span<const std::int32_t> face_group);
  // All edges, in group 0.
  void add_all();
  // Computes where the nodes are.
  void place_nodes(unsigned threads, const base::Monitor& monitor);
  // Joins corners; arcs that are met in their inside are divided. Gives how many lines lead to no node. Lines
  // from one corner follow each other.
  std::size_t add_lines(std::span<const CornerBisector> lines, std::span<const std::int32_t> face_group,
                        const skeleton::JoinedGroups& joined);
  // Keeps what is in a frame of the arcs of a group.
  void clip(std::int32_t group, const skeleton::Frame& frame);

  std::span<const skeleton::GraphArc> arcs() const {
    return arcs_;
  }  // left and right are seeds, of lines segments
  const ArcOrigin& origin(std::size_t arc) const { return origin_[arc]; }
  std::size_t node_count() const { return place_.size(); }
  const kernel::Point& place(std::int32_t node) const { return place_[static_cast<std::size_t>(node)]; }
  skeleton::FrameSide side(std::int32_t node) const { return side_[static_cast<std::size_t>(node)]; }

 private:
  struct Division;

  bool is_wanted(Side s, std::span<const std::int32_t> face_group) const;
  void add_side(Side s, std::int32_t group);
  void add_chain_link(std::int32_t p, std::int32_t q, std::int32_t group);
  std::int32_t node_of(Triangle t);
  std::int32_t add_node(const kernel::Point& place, skeleton::FrameSide side);
  std::optional<std::int32_t> node_at_corner(std::int32_t corner, std::int32_t group) const;
  void add_arc(const skeleton::GraphArc& arc, const ArcOrigin& origin);
  std::optional<std::size_t> arc_of(Side s) const;
  void divide(std::vector<Division>& divisions);
  skeleton::Line line_of(const skeleton::GraphArc& arc) const;

  const SampleDiagram& diagram_;
  std::vector<skeleton::GraphArc> arcs_;
  std::vector<ArcOrigin> origin_;
  std::vector<std::int32_t> node_of_;    // [triangles] -1: none
  std::vector<Triangle> node_triangle_;  // [nodes that are circumcenters]
  std::vector<kernel::Point> place_;
  std::vector<skeleton::FrameSide> side_;
};

}  // namespace vorotool::core::sampled_skeleton
