// Critical values of skeletons, and what is left for a threshold.
#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/pruning/arc_profile.hpp"
#include "core/pruning/critical_values.hpp"
#include "core/pruning/pruning.hpp"

namespace vorotool::bindings {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using core::base::Monitor;
using core::kernel::Point;
using Pair = std::array<std::int32_t, 2>;

using SkeletonTuple = nb::typed<nb::tuple, nb::any, nb::ellipsis>;

// The arrays of a skeleton, kept while the core works on views of them.
struct SkeletonInput {
  Matrix<const double> vertices;
  Vector<const double> radius;
  Matrix<const std::int32_t> arcs;
  Matrix<const double> control;
  Matrix<const std::int32_t> sites;
  Vector<const double> length;
  Matrix<const double> site_ends;  // four columns
  Vector<const std::uint8_t> is_anchored;
  bool has_gap;
  double reach;

  SkeletonInput(const SkeletonTuple& arrays)
      : vertices(cast<Matrix<const double>>(arrays, 0)),
        radius(cast<Vector<const double>>(arrays, 1)),
        arcs(cast<Matrix<const std::int32_t>>(arrays, 2)),
        control(cast<Matrix<const double>>(arrays, 3)),
        sites(cast<Matrix<const std::int32_t>>(arrays, 4)),
        length(cast<Vector<const double>>(arrays, 5)),
        site_ends(cast<Matrix<const double>>(arrays, 6)),
        is_anchored(cast<Vector<const std::uint8_t>>(arrays, 7)),
        has_gap(nb::cast<bool>(arrays[8])),
        reach(nb::cast<double>(arrays[9])) {}

  // Without the ends of sites only for what looks at none.
  core::skeleton::SkeletonView skeleton(bool needs_sites = true) const {
    const core::skeleton::SkeletonView s{rows<Point>(vertices),
                                         view(radius),
                                         rows<Pair>(arcs),
                                         rows<Point>(control),
                                         rows<Pair>(sites),
                                         view(length),
                                         rows<std::array<Point, 2>, 4>(site_ends),
                                         view(is_anchored),
                                         has_gap,
                                         reach};
    const std::size_t nodes = s.vertices.size(), count = s.arcs.size();
    if (s.radius.size() != nodes || s.is_anchored.size() != nodes || s.control.size() != count ||
        s.sites.size() != count || s.length.size() != count) {
      throw std::invalid_argument("the arrays of a skeleton have lengths that do not go together");
    }
    check_range(s.arcs, nodes);
    if (needs_sites) check_range(s.sites, s.site_ends.size());
    return s;
  }

 private:
  template <class Array>
  static Array cast(const SkeletonTuple& arrays, std::size_t index) {
    return nb::cast<Array>(arrays[index], false);
  }
  static void check_range(std::span<const Pair> pairs, std::size_t count) {
    for (const Pair& pair : pairs) {
      for (const std::int32_t index : pair) {
        if (index < 0 || static_cast<std::size_t>(index) >= count) {
          throw std::invalid_argument("an index of the skeleton is out of range");
        }
      }
    }
  }
};

core::pruning::Criterion criterion_of(int number) {
  if (number < 0 || number > 4) throw std::invalid_argument("there are five criteria");
  return static_cast<core::pruning::Criterion>(number);
}

auto critical_values(const SkeletonTuple& arrays, int criterion, const Progress& progress) {
  const SkeletonInput input(arrays);
  const core::pruning::Criterion wanted = criterion_of(criterion);
  const core::skeleton::SkeletonView skeleton = input.skeleton(wanted != core::pruning::Criterion::scale);
  core::pruning::CriticalValues values = run_interruptible(progress, [&](const Monitor& monitor) {
    return core::pruning::critical_values(skeleton, wanted, monitor);
  });
  return std::make_tuple(two_columns(std::move(values.ends)), to_numpy(std::move(values.most)),
                         column<std::int32_t>(values.kept, [](const auto& place) { return place.arc; }),
                         column<double>(values.kept, [](const auto& place) { return place.parameter; }));
}

Columns prune_skeleton(const SkeletonTuple& arrays, int criterion, double threshold,
                       const Vector<const std::int32_t>& group, const Progress& progress) {
  const SkeletonInput input(arrays);
  const core::pruning::Criterion wanted = criterion_of(criterion);
  const core::skeleton::SkeletonView skeleton = input.skeleton(wanted != core::pruning::Criterion::scale);
  if (group.size() != skeleton.arcs.size()) throw std::invalid_argument("each arc must have a group");
  core::pruning::PrunedSkeleton left = run_interruptible(progress, [&](const Monitor& monitor) {
    const core::pruning::CriticalValues values = core::pruning::critical_values(skeleton, wanted, monitor);
    const auto parts = core::pruning::parts_left(skeleton, values, wanted, threshold);
    return core::pruning::pruned_skeleton(skeleton, parts, view(group), monitor);
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

auto arc_profiles(const SkeletonTuple& arrays) {
  const SkeletonInput input(arrays);
  const core::skeleton::SkeletonView skeleton = input.skeleton();
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

Columns part_geometry(const SkeletonTuple& arrays, const Vector<const std::int32_t>& arc,
                      const Vector<const double>& first, const Vector<const double>& last) {
  const SkeletonInput input(arrays);
  const core::skeleton::SkeletonView skeleton = input.skeleton();
  if (first.size() != arc.size() || last.size() != arc.size())
    throw std::invalid_argument("each part must have an arc and two ends");
  std::vector<Point> from, to, control;
  std::vector<double> from_radius, to_radius, length;
  for (std::size_t k = 0; k < arc.size(); ++k) {
    const core::pruning::ArcPart part{view(arc)[k], view(first)[k], view(last)[k]};
    if (part.arc < 0 || static_cast<std::size_t>(part.arc) >= skeleton.arcs.size())
      throw std::invalid_argument("an arc is out of range");
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
  room.def(
      "critical_values", &critical_values, "skeleton"_a, "criterion"_a, "progress"_a.none(),
      "Values at the ends of arcs and the largest of each; arcs on which a place is kept, and where. Of the "
      "angle: the tangent of half of it.");
  room.def("prune_skeleton", &prune_skeleton, "skeleton"_a, "criterion"_a, "threshold"_a, "group"_a,
           "progress"_a.none());
  room.def("arc_profiles", &arc_profiles, "skeleton"_a,
           "Kinds (between lines, between points, parabola), x at the ends, and h or the tangent of half the "
           "angle.");
  room.def("part_geometry", &part_geometry, "skeleton"_a, "arc"_a, "first"_a, "last"_a,
           "Places and radii of both ends, control points and lengths of parts of arcs.");
}

}  // namespace vorotool::bindings
