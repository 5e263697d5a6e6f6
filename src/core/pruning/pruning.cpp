#include "core/pruning/pruning.hpp"

#include <algorithm>

#include "core/numbers/special_values.hpp"
#include "core/pruning/arc_profile.hpp"
#include "core/skeleton/branches.hpp"

namespace vorotool::core::pruning {

using base::at;
using kernel::Point;
using numbers::infinity;
using numbers::nan;
using skeleton::ArcEnd;
using skeleton::GraphArc;
using skeleton::SkeletonView;

namespace {

// Where an arc is cut that has less than the threshold at its source or its target, or at both.
ArcPart cut(const SkeletonView& skeleton, const CriticalValues& values, Criterion criterion, double threshold,
            std::int32_t arc) {
  const auto kept = std::lower_bound(values.kept.begin(), values.kept.end(), arc,
                                     [](const KeptPlace& place, std::int32_t k) { return place.arc < k; });
  const bool is_kept = kept != values.kept.end() && kept->arc == arc;
  const bool has_course = criterion == Criterion::angle || criterion == Criterion::chord;
  if (!has_course) return {arc, kept->parameter, kept->parameter};  // whole arcs go, but for a place
  const ArcProfile profile(skeleton, at(arc));
  const double most = criterion == Criterion::angle ? profile.angle().most : profile.chord().most;
  const auto reached = [&](bool from_target) {
    if (most < threshold) return kept->parameter;
    const double u = criterion == Criterion::angle ? profile.angle_reached(threshold, from_target)
                                                   : profile.chord_reached(threshold, from_target);
    if (!is_kept) return u;
    return from_target ? std::max(u, kept->parameter) : std::min(u, kept->parameter);
  };
  const auto [source, target] = values.ends[at(arc)];
  return {arc, source < threshold ? reached(false) : 0, target < threshold ? reached(true) : 1};
}

Point between(const Point& a, const Point& b, double u) {
  return {a.x + u * (b.x - a.x), a.y + u * (b.y - a.y)};
}

ArcEnd end_at(const SkeletonView& skeleton, std::int32_t arc, double u) {
  const Point source = skeleton.source(at(arc)), target = skeleton.target(at(arc));
  if (u == 0) return {source, skeleton.source_radius(at(arc))};
  if (u == 1) return {target, skeleton.target_radius(at(arc))};
  Point place = between(source, target, u);
  if (skeleton.is_curved(at(arc))) {
    const Point& control = skeleton.control[at(arc)];
    place = between(between(source, control, u), between(control, target, u), u);
  }
  return {place, ArcProfile(skeleton, at(arc)).radius(u)};
}

bool is_whole(const ArcPart& part) { return part.first == 0 && part.last == 1; }

// Of a part of a quadratic Bezier curve: its blossom. A single place is no curve.
Point control_of(const SkeletonView& skeleton, const ArcPart& part) {
  const Point& whole = skeleton.control[at(part.arc)];
  if (is_whole(part)) return whole;
  if (!skeleton.is_curved(at(part.arc)) || part.first == part.last) return {nan, nan};
  return between(between(skeleton.source(at(part.arc)), whole, part.first),
                 between(whole, skeleton.target(at(part.arc)), part.first), part.last);
}

double length_of(const SkeletonView& skeleton, const ArcPart& part) {
  if (is_whole(part)) return skeleton.length[at(part.arc)];
  if (part.first == part.last) return 0;
  return ArcProfile(skeleton, at(part.arc)).length(part.first, part.last);
}

class PartWriter {
 public:
  PartWriter(const SkeletonView& skeleton, std::span<const ArcPart> parts)
      : skeleton_(skeleton), parts_(parts) {
    arcs_.reserve(parts.size());
  }

  // The arcs as a graph; ends that were cut are nodes beyond those of the skeleton.
  std::span<const GraphArc> graph(std::span<const std::int32_t> group) {
    for (const ArcPart& part : parts_) {
      const auto [source, target] = skeleton_.arcs[at(part.arc)];
      const auto [left, right] = skeleton_.sites[at(part.arc)];
      const std::int32_t first = part.first == 0 ? source : add_node(part.arc, part.first);
      const std::int32_t last = part.last == 1 ? target : add_node(part.arc, part.last);
      arcs_.push_back({first, last, left, right, group[at(part.arc)]});
    }
    return arcs_;
  }
  std::size_t node_count() const { return skeleton_.vertices.size() + extra_.size(); }

  PrunedSkeleton write(const skeleton::SkeletonOrder& order) const {
    PrunedSkeleton out = reserved(order);
    for (const std::int32_t node : order.nodes) {
      const bool is_old = at(node) < skeleton_.vertices.size();
      const ArcEnd end = is_old ? ArcEnd{skeleton_.vertices[at(node)], skeleton_.radius[at(node)]}
                                : extra_[at(node) - skeleton_.vertices.size()];
      out.vertices.push_back(end.place);
      out.radius.push_back(end.radius);
    }
    for (const skeleton::OrderedArc& arc : order.arcs) {
      const ArcPart& part = parts_[at(arc.arc)];
      out.arcs.push_back({arc.source, arc.target});
      out.control.push_back(control_of(skeleton_, part));
      out.length.push_back(length_of(skeleton_, part));
      out.branch.push_back(arc.branch);
      out.original.push_back(part.arc);
      out.is_reversed.push_back(arc.is_reversed ? 1 : 0);
    }
    return out;
  }

 private:
  static PrunedSkeleton reserved(const skeleton::SkeletonOrder& order) {
    PrunedSkeleton out;
    out.vertices.reserve(order.nodes.size());
    out.radius.reserve(order.nodes.size());
    out.arcs.reserve(order.arcs.size());
    out.control.reserve(order.arcs.size());
    out.length.reserve(order.arcs.size());
    out.branch.reserve(order.arcs.size());
    out.original.reserve(order.arcs.size());
    out.is_reversed.reserve(order.arcs.size());
    return out;
  }

  std::int32_t add_node(std::int32_t arc, double u) {
    extra_.push_back(end_at(skeleton_, arc, u));
    return static_cast<std::int32_t>(node_count() - 1);
  }

  const SkeletonView& skeleton_;
  std::span<const ArcPart> parts_;
  std::vector<GraphArc> arcs_;
  std::vector<ArcEnd> extra_;
};

}  // namespace

PartGeometry part_geometry(const SkeletonView& skeleton, const ArcPart& part) {
  return {end_at(skeleton, part.arc, part.first), end_at(skeleton, part.arc, part.last),
          control_of(skeleton, part), length_of(skeleton, part)};
}

namespace {

bool is_place(const ArcPart& part) { return part.first == part.last; }

// A single place stays only where nothing else does.
void drop_places(const SkeletonView& skeleton, const CriticalValues& values, std::vector<ArcPart>& parts) {
  if (std::none_of(parts.begin(), parts.end(), is_place)) return;
  std::vector<bool> has_arc(skeleton.vertices.size());
  for (const ArcPart& part : parts) {
    if (part.first == 0 && part.last > 0) has_arc[at(skeleton.arcs[at(part.arc)][0])] = true;
    if (part.last == 1 && part.first < 1) has_arc[at(skeleton.arcs[at(part.arc)][1])] = true;
  }
  std::erase_if(parts, [&](const ArcPart& part) {
    if (!is_place(part)) return false;
    if (values.most[at(part.arc)] < infinity) return true;  // where the next arc begins
    const auto [source, target] = skeleton.arcs[at(part.arc)];
    return (part.first == 0 && has_arc[at(source)]) || (part.last == 1 && has_arc[at(target)]);
  });
}

}  // namespace

std::vector<ArcPart> parts_left(const SkeletonView& skeleton, const CriticalValues& values,
                                Criterion criterion, double threshold) {
  std::vector<ArcPart> parts;
  for (std::size_t k = 0; k < values.most.size(); ++k) {
    if (values.most[k] < threshold) continue;
    const auto arc = static_cast<std::int32_t>(k);
    const bool is_whole = values.ends[k][0] >= threshold && values.ends[k][1] >= threshold;
    const ArcPart part = is_whole ? ArcPart{arc, 0, 1} : cut(skeleton, values, criterion, threshold, arc);
    parts.push_back(part);
  }
  drop_places(skeleton, values, parts);
  return parts;
}

PrunedSkeleton pruned_skeleton(const SkeletonView& skeleton, std::span<const ArcPart> parts,
                               std::span<const std::int32_t> group, const base::Monitor& monitor) {
  PartWriter writer(skeleton, parts);
  const std::span<const GraphArc> arcs = writer.graph(group);
  return writer.write(skeleton::order_by_branches(arcs, writer.node_count(), monitor));
}

}  // namespace vorotool::core::pruning
