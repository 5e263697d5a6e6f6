#include "core/sampled_skeleton/sampled_skeleton.hpp"

#include <algorithm>
#include <atomic>
#include <limits>

#include "core/base/atomic_ref.hpp"
#include "core/base/parallel.hpp"
#include "core/numbers/special_values.hpp"
#include "core/sampled_skeleton/corner_bisectors.hpp"
#include "core/sampled_skeleton/error_bounds.hpp"
#include "core/sampled_skeleton/sample_arcs.hpp"
#include "core/skeleton/branches.hpp"

namespace vorotool::core::sampled_skeleton {

using base::Monitor;
using kernel::Point;
using numbers::nan;
using skeleton::GraphArc;
using skeleton::LatticeToInput;
using skeleton::OrderedArc;
using skeleton::SkeletonArrays;

namespace {

// Several threads may do this at once.
void lower(double& value, double other) {
  base::atomic_ref<double> shared(value);
  double so_far = shared.load(std::memory_order_relaxed);
  while (other < so_far && !shared.compare_exchange_weak(so_far, other, std::memory_order_relaxed)) {
  }
}

class Writer {
 public:
  Writer(const SampleDiagram& diagram, const SampleArcs& arcs, const LatticeToInput& place,
         const Monitor& monitor)
      : diagram_(diagram),
        arcs_(arcs),
        place_(place),
        order_(skeleton::order_by_branches(arcs.arcs(), arcs.node_count(), monitor)) {}

  void write(SampledSkeleton& out, unsigned threads, const Monitor& monitor) const {
    constexpr std::size_t grain = 1 << 14;
    const std::size_t nodes = order_.nodes.size(), arcs = order_.arcs.size();
    SkeletonArrays& a = out.arrays;
    a.vertices.resize(nodes);
    a.side.resize(nodes);
    a.arcs.resize(arcs);
    a.control.assign(arcs, {nan, nan});
    a.sites.resize(arcs);
    a.group.resize(arcs);
    a.branch.resize(arcs);
    a.length.resize(arcs);
    out.seeds.resize(arcs);
    base::for_items(nodes, grain, threads, monitor, [&](std::size_t i) { write_node(i, a); });
    base::for_items(arcs, grain, threads, monitor, [&](std::size_t i) { write_arc(i, out); });
  }

  // Bounds and clearances; of nodes the least that any of their arcs found.
  void write_bounds(SampledSkeleton& out, double tolerance, unsigned threads, const Monitor& monitor) const {
    const auto arc = [&](std::size_t i) {
      const OrderedArc& ordered = order_.arcs[i];
      const GraphArc& own = graph_arc(ordered);
      const ArcOrigin& origin = arcs_.origin(static_cast<std::size_t>(ordered.arc));
      return BoundedArc{{arcs_.place(own.source), arcs_.place(own.target)},
                        origin.side,
                        origin.corner < 0 ? own.left : origin.corner,
                        origin.corner};
    };
    out.error.resize(order_.arcs.size());
    out.arrays.radius.assign(order_.nodes.size(), std::numeric_limits<double>::infinity());
    const auto take = [&](std::size_t i, const ErrorBound& bound) {
      const OrderedArc& ordered = order_.arcs[i];
      out.error[i] = place_.scale * bound.error;
      for (std::size_t end = 0; end < 2; ++end) {
        const std::int32_t node = (end == 0) != ordered.is_reversed ? ordered.source : ordered.target;
        lower(out.arrays.radius[static_cast<std::size_t>(node)], place_.scale * bound.radius[end]);
      }
    };
    bound_arcs(diagram_, {order_.arcs.size(), arc, take}, tolerance, out.parts, threads, monitor);
  }

  // The distances of nodes from the seeds, where nothing is bounded.
  void write_radii(SampledSkeleton& out) const {
    out.error.assign(order_.arcs.size(), nan);
    out.arrays.radius.resize(order_.nodes.size());
    for (const OrderedArc& ordered : order_.arcs) {
      const kernel::Point& seed = diagram_.mesh().seed(graph_arc(ordered).left);
      for (const std::int32_t node : {ordered.source, ordered.target}) {
        const Point& place = arcs_.place(order_.nodes[static_cast<std::size_t>(node)]);
        out.arrays.radius[static_cast<std::size_t>(node)] = place_.scale * norm(place - seed);
      }
    }
  }

 private:
  const GraphArc& graph_arc(const OrderedArc& ordered) const {
    return arcs_.arcs()[static_cast<std::size_t>(ordered.arc)];
  }

  void write_node(std::size_t i, SkeletonArrays& a) const {
    a.vertices[i] = place_(arcs_.place(order_.nodes[i]));
    a.side[i] = static_cast<std::int8_t>(arcs_.side(order_.nodes[i]));
  }

  void write_arc(std::size_t i, SampledSkeleton& out) const {
    const OrderedArc& ordered = order_.arcs[i];
    const GraphArc& arc = graph_arc(ordered);
    const bool completes = arcs_.origin(static_cast<std::size_t>(ordered.arc)).corner >= 0;
    const auto points = static_cast<std::int32_t>(diagram_.labels().graph().points.size());
    SkeletonArrays& a = out.arrays;
    a.arcs[i] = {ordered.source, ordered.target};
    a.sites[i] = completes
                     ? std::array{points + arc.left, points + arc.right}
                     : std::array{diagram_.labels().site_of(arc.left), diagram_.labels().site_of(arc.right)};
    out.seeds[i] = completes ? std::array{-1, -1} : std::array{arc.left, arc.right};
    if (ordered.is_reversed) {
      std::swap(a.sites[i][0], a.sites[i][1]);
      std::swap(out.seeds[i][0], out.seeds[i][1]);
    }
    a.group[i] = arc.group;
    a.branch[i] = ordered.branch;
    const Point &source = arcs_.place(arc.source), &target = arcs_.place(arc.target);
    a.length[i] = place_.scale * norm(target - source);
  }

  const SampleDiagram& diagram_;
  const SampleArcs& arcs_;
  const LatticeToInput& place_;
  skeleton::SkeletonOrder order_;
};

}  // namespace

SampledSkeleton extract_sampled_skeleton(const SampleDiagram& diagram, const SampledSkeletonOptions& options,
                                         const LatticeToInput& place, unsigned threads,
                                         const Monitor& monitor) {
  SampledSkeleton made;
  SampleArcs arcs(diagram);
  if (options.whole) {
    arcs.add_all();
  } else {
    arcs.add_kept(options.face_group);
  }
  arcs.place_nodes(threads, monitor);
  if (options.complete) {
    const CornerBisectors lines = corner_bisectors(diagram, options.face_group, threads, monitor);
    made.open_corners = lines.open + arcs.add_lines(lines.lines, options.face_group, options.joined);
  }
  if (options.clipped) arcs.clip(options.clipped->group, options.clipped->frame);
  const Writer writer(diagram, arcs, place, monitor);
  writer.write(made, threads, monitor);
  if (options.whole) {
    writer.write_radii(made);
    return made;
  }
  if (options.tolerance > 0) made.parts.assign(diagram.labels().piece_count(), 1);
  writer.write_bounds(made, options.tolerance, threads, monitor);
  return made;
}

}  // namespace vorotool::core::sampled_skeleton
