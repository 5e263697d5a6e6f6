#include "core/skeleton/extraction.hpp"

#include <algorithm>

#include "core/base/parallel.hpp"
#include "core/numbers/special_values.hpp"
#include "core/skeleton/branches.hpp"
#include "core/skeleton/graph.hpp"

namespace vorotool::core::skeleton {
using numbers::nan;

namespace {

constexpr std::size_t arcs_a_piece = 1 << 14;  // a millisecond or so

class ArrayWriter {
 public:
  ArrayWriter(const SkeletonGraph& graph, const SkeletonOrder& order, const LatticeToInput& place)
      : graph_(graph), order_(order), place_(place) {
    const std::size_t nodes = order.nodes.size(), arcs = order.arcs.size();
    out_.vertices.resize(nodes);
    out_.radius.resize(nodes);
    out_.side.resize(nodes);
    out_.arcs.resize(arcs);
    out_.control.resize(arcs);
    out_.sites.resize(arcs);
    out_.group.resize(arcs);
    out_.branch.resize(arcs);
    out_.length.resize(arcs);
  }

  void write_node(std::size_t i) {
    const ArcEnd end = graph_.end(order_.nodes[i]);
    out_.vertices[i] = place_(end.place);
    out_.radius[i] = place_.scale * end.radius;
    out_.side[i] = static_cast<std::int8_t>(graph_.side(order_.nodes[i]));
  }

  void write_arc(std::size_t i) {
    const OrderedArc& ordered = order_.arcs[i];
    const GraphArc& arc = graph_.arcs[static_cast<std::size_t>(ordered.arc)];
    out_.arcs[i] = {ordered.source, ordered.target};
    out_.sites[i] = {arc.left, arc.right};
    if (ordered.is_reversed) std::swap(out_.sites[i][0], out_.sites[i][1]);
    out_.group[i] = arc.group;
    out_.branch[i] = ordered.branch;
    const ArcEnd source = graph_.end(arc.source), target = graph_.end(arc.target);
    const BisectorArc bisector = graph_.bisector(arc);
    if (bisector.is_parabola) {
      out_.control[i] = place_(control_point(bisector.parabola, source, target));
      out_.length[i] = place_.scale * arc_length(bisector.parabola, source, target);
    } else {
      out_.control[i] = {nan, nan};
      out_.length[i] = place_.scale * norm(target.place - source.place);
    }
  }

  SkeletonArrays take() { return std::move(out_); }

 private:
  const SkeletonGraph& graph_;
  const SkeletonOrder& order_;
  const LatticeToInput& place_;
  SkeletonArrays out_;
};

}  // namespace

SkeletonArrays extract_skeleton(const segment_voronoi::build::DiagramView& diagram,
                                std::span<const std::int32_t> edges, std::span<const std::int32_t> groups,
                                const std::optional<ClippedGroup>& clipped, const JoinedGroups& joined,
                                const LatticeToInput& place, unsigned threads, const base::Monitor& monitor) {
  SkeletonGraph graph(diagram, edges, groups);
  graph.join_corners(joined.first, joined.last);
  if (clipped) clip_to_frame(graph, clipped->group, clipped->frame, monitor);
  const SkeletonOrder order = order_by_branches(graph.arcs, graph.node_count(), monitor);
  ArrayWriter writer(graph, order, place);
  base::for_items(order.nodes.size(), arcs_a_piece, threads, monitor,
                  [&](std::size_t i) { writer.write_node(i); });
  base::for_items(order.arcs.size(), arcs_a_piece, threads, monitor,
                  [&](std::size_t i) { writer.write_arc(i); });
  return writer.take();
}

}  // namespace vorotool::core::skeleton
