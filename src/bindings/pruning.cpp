// Critical values of skeletons, and what is left for a threshold.
#include <array>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/skeleton_input.hpp"
#include "core/base/indices.hpp"
#include "core/pruning/arc_profile.hpp"
#include "core/pruning/critical_values.hpp"
#include "core/pruning/pruning.hpp"

namespace vorotool::bindings {
namespace {

using core::base::IndexPair;
using core::base::Monitor;
using core::kernel::Point;
using core::pruning::Criterion;
using core::skeleton::SkeletonView;

// Some that follow each other.
struct Range {
  std::size_t first, count;

  Range(const nb::slice& slice, std::size_t size) {
    const auto [start, stop, step, length] = slice.compute(size);
    if (step != 1) throw std::invalid_argument("a part is what follows each other");
    first = static_cast<std::size_t>(start), count = length;
  }
  template <class T>
  std::span<const T> of(std::span<const T> all) const {
    return all.subspan(first, count);
  }
};

// Ends of arcs, by their places among some nodes.
std::vector<IndexPair> renumbered(std::span<const IndexPair> arcs, const Range& nodes) {
  std::vector<IndexPair> ends(arcs.begin(), arcs.end());
  for (IndexPair& pair : ends) {
    for (std::int32_t& node : pair) node -= static_cast<std::int32_t>(nodes.first);
  }
  core::base::check_range(ends, 0, nodes.count, SkeletonInput::outside);
  return ends;
}

SkeletonView part_of(const SkeletonView& whole, const Range& arcs, const Range& nodes,
                     std::span<const IndexPair> ends) {
  return {nodes.of(whole.vertices),
          nodes.of(whole.radius),
          ends,
          arcs.of(whole.control),
          arcs.of(whole.sites),
          arcs.of(whole.length),
          whole.site_ends,
          nodes.of(whole.is_anchored),
          whole.has_gap,
          whole.reach};
}

auto critical_values(const SkeletonInput& input, Criterion criterion, const Progress& progress) {
  const SkeletonView& skeleton = input.view(criterion != Criterion::scale);
  core::pruning::CriticalValues values =
      run_interruptible(progress, core::pruning::critical_values, skeleton, criterion);
  return std::make_tuple(two_columns(std::move(values.ends)), to_numpy(std::move(values.most)),
                         column<std::int32_t>(values.kept, [](const auto& place) { return place.arc; }),
                         column<double>(values.kept, [](const auto& place) { return place.parameter; }));
}

// What is left of some arcs, whose nodes have nothing in common with others.
Columns prune_skeleton(const SkeletonInput& input, const nb::slice& arcs, const nb::slice& nodes,
                       Criterion criterion, double threshold, const Indices& group,
                       const Progress& progress) {
  const SkeletonView& whole = input.view(criterion != Criterion::scale);
  if (group.size() != whole.arcs.size()) throw std::invalid_argument("each arc must have a group");
  const Range own_arcs(arcs, whole.arcs.size()), own_nodes(nodes, whole.vertices.size());
  const std::vector<IndexPair> ends = renumbered(own_arcs.of(whole.arcs), own_nodes);
  const SkeletonView skeleton = part_of(whole, own_arcs, own_nodes, ends);
  core::pruning::PrunedSkeleton left = run_interruptible(progress, [&](const Monitor& monitor) {
    const core::pruning::CriticalValues values = core::pruning::critical_values(skeleton, criterion, monitor);
    const auto parts = core::pruning::parts_left(skeleton, values, criterion, threshold);
    return core::pruning::pruned_skeleton(skeleton, parts, own_arcs.of(view(group)), monitor);
  });
  Columns result;
  result["vertices"] = two_columns(std::move(left.vertices));
  result["radius"] = to_numpy(std::move(left.radius));
  result["arcs"] = two_columns(std::move(left.arcs));
  result["control"] = two_columns(std::move(left.control));
  result["length"] = to_numpy(std::move(left.length));
  result["branch"] = to_numpy(std::move(left.branch));
  result["original"] = to_numpy(std::move(left.original));
  result["is_reversed"] = to_numpy(std::move(left.is_reversed));
  return result;
}

auto arc_profiles(const SkeletonInput& input) {
  const SkeletonView& skeleton = input.view();
  const std::size_t count = skeleton.arcs.size();
  std::vector<std::int8_t> kind(count);
  std::vector<std::array<double, 2>> ends(count);
  std::vector<double> size(count);
  for (std::size_t k = 0; k < count; ++k) {
    const core::pruning::ArcProfile profile(skeleton, k);
    kind[k] = static_cast<std::int8_t>(profile.kind);
    ends[k] = {profile.from, profile.to};
    size[k] = profile.size;
  }
  return std::make_tuple(to_numpy(std::move(kind)), two_columns(std::move(ends)), to_numpy(std::move(size)));
}

Columns part_geometry(const SkeletonInput& input, const Indices& arc, const Vector<const double>& first,
                      const Vector<const double>& last) {
  const SkeletonView& skeleton = input.view();
  if (first.size() != arc.size() || last.size() != arc.size())
    throw std::invalid_argument("each part must have an arc and two ends");
  core::base::check_range(view(arc), 0, skeleton.arcs.size(), "an arc is out of range");
  std::vector<Point> from, to, control;
  std::vector<double> from_radius, to_radius, length;
  for (std::size_t k = 0; k < arc.size(); ++k) {
    const core::pruning::ArcPart part{view(arc)[k], view(first)[k], view(last)[k]};
    const core::pruning::PartGeometry geometry = core::pruning::part_geometry(skeleton, part);
    from.push_back(geometry.first.place);
    to.push_back(geometry.last.place);
    control.push_back(geometry.control);
    from_radius.push_back(geometry.first.radius);
    to_radius.push_back(geometry.last.radius);
    length.push_back(geometry.length);
  }
  Columns result;
  result["first"] = two_columns(std::move(from));
  result["last"] = two_columns(std::move(to));
  result["first_radius"] = to_numpy(std::move(from_radius));
  result["last_radius"] = to_numpy(std::move(to_radius));
  result["control"] = two_columns(std::move(control));
  result["length"] = to_numpy(std::move(length));
  return result;
}

}  // namespace

void bind_pruning(nb::module_& room) {
  nb::enum_<Criterion>(room, "Criterion")
      .value("angle", Criterion::angle)
      .value("chord", Criterion::chord)
      .value("scale", Criterion::scale)
      .value("length", Criterion::length)
      .value("ratio", Criterion::ratio);
  room.def(
      "critical_values", &critical_values, "skeleton"_a, "criterion"_a, "progress"_a.none(),
      "Values at the ends of arcs and the largest of each; arcs on which a place is kept, and where. Of the "
      "angle: the tangent of half of it.");
  room.def("prune_skeleton", &prune_skeleton, "skeleton"_a, "arcs"_a, "nodes"_a, "criterion"_a, "threshold"_a,
           "group"_a, "progress"_a.none(),
           "What is left of some arcs, whose nodes, numbered from the first of them, are no others'.");
  room.def("arc_profiles", &arc_profiles, "skeleton"_a,
           "Kinds (between lines, between points, parabola), x at the ends, and h or the tangent of half the "
           "angle.");
  room.def("part_geometry", &part_geometry, "skeleton"_a, "arc"_a, "first"_a, "last"_a,
           "Places and radii of both ends, control points and lengths of parts of arcs.");
}

}  // namespace vorotool::bindings
