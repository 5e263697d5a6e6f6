// From segment Voronoi diagrams to skeletons.
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/segment_diagram.hpp"
#include "bindings/support/skeleton_arrays.hpp"
#include "bindings/support/skeleton_input.hpp"
#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/skeleton/clearance_course.hpp"
#include "core/skeleton/edges.hpp"
#include "core/skeleton/extraction.hpp"
#include "core/skeleton/steps.hpp"

namespace vorotool::bindings {
namespace {

using core::base::Monitor;

auto skeleton_edges(const SegmentDiagram& input, unsigned threads, const Progress& progress) {
  const core::segment_voronoi::build::DiagramView& diagram = input.view_with_faces();
  core::skeleton::SkeletonEdges kept = run_interruptible(progress, core::skeleton::skeleton_edges, diagram,
                                                         core::base::resolve_threads(threads));
  return std::make_tuple(to_numpy(std::move(kept.edge)), to_numpy(std::move(kept.face)));
}

Columns extract_skeleton(const SegmentDiagram& input, const Indices& kept, const Indices& groups,
                         const Clipped& clipped, const std::pair<std::int32_t, std::int32_t>& joined,
                         double origin_x, double origin_y, double scale, unsigned threads,
                         const Progress& progress) {
  const core::segment_voronoi::build::DiagramView& diagram = input.view();
  if (kept.size() != groups.size()) throw std::invalid_argument("each edge must have one group");
  const std::optional<core::skeleton::ClippedGroup> frame = clipped_group(clipped);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const std::int32_t edge = view(kept)[k], group = view(groups)[k];
    if (edge < 0 || static_cast<std::size_t>(edge) >= diagram.edges.size() || group < 0) {
      throw std::invalid_argument("an edge or a group is out of range");
    }
    const auto& ends = diagram.edges[static_cast<std::size_t>(edge)];
    if ((ends[0] < 0 || ends[1] < 0) && !(frame && frame->group == group)) {
      throw std::invalid_argument("an unbounded edge is in no frame");
    }
  }
  return as_dict(run_interruptible(progress, [&](const Monitor& monitor) {
    return core::skeleton::extract_skeleton(diagram, view(kept), view(groups), frame,
                                            {joined.first, joined.second}, {origin_x, origin_y, scale},
                                            core::base::resolve_threads(threads), monitor);
  }));
}

Columns steps_along(const SkeletonInput& input, const Vector<const std::int64_t>& first,
                    const Vector<const std::int64_t>& counts, double every, unsigned threads,
                    const Progress& progress) {
  const core::skeleton::SkeletonView& skeleton = input.view();
  const std::size_t branches = first.size();
  if (counts.size() != branches) throw std::invalid_argument("each branch must have a count");
  for (std::size_t k = 0; k < branches; ++k) {
    const std::int64_t arc = view(first)[k];
    const bool is_next = k == 0 ? arc == 0 : arc > view(first)[k - 1];
    if (!is_next || static_cast<std::size_t>(arc) >= skeleton.arcs.size() || view(counts)[k] < 0) {
      throw std::invalid_argument("a branch is out of range");
    }
  }
  core::skeleton::Steps made = run_interruptible(progress, [&](const Monitor& monitor) {
    return core::skeleton::steps_along(skeleton, view(first), view(counts), every,
                                       core::base::resolve_threads(threads), monitor);
  });
  Columns result;
  result["arc"] = to_numpy(std::move(made.arc));
  result["along"] = to_numpy(std::move(made.along));
  result["xy"] = two_columns(std::move(made.place));
  result["radius"] = to_numpy(std::move(made.radius));
  result["feet"] = pairs_of_places(std::move(made.feet));
  return result;
}

auto clearance_course(const Places& vertices, const Vector<const double>& radius, const IndexRows& arcs,
                      const IndexRows& sites, const IndexRows& site_places, double error,
                      bool sites_are_exact, unsigned threads, const Progress& progress) {
  static constexpr const char* outside = "an index of the skeleton is out of range";
  const core::skeleton::PlacedSkeleton skeleton{rows<core::kernel::Point>(vertices),
                                                view(radius),
                                                rows<core::base::IndexPair>(arcs),
                                                rows<core::base::IndexPair>(sites),
                                                rows<core::kernel::LatticeSite>(site_places),
                                                error,
                                                sites_are_exact};
  if (radius.size() != skeleton.vertices.size() || skeleton.sites.size() != skeleton.arcs.size()) {
    throw std::invalid_argument("the arrays of a skeleton have lengths that do not go together");
  }
  core::base::check_range(skeleton.arcs, 0, skeleton.vertices.size(), outside);
  core::base::check_range(skeleton.sites, 0, skeleton.site_places.size(), outside);
  auto made = run_interruptible(progress, core::skeleton::clearance_course, skeleton,
                                core::base::resolve_threads(threads));
  return std::make_tuple(two_columns(std::move(made.slope)), to_numpy(std::move(made.least)));
}

}  // namespace

void bind_skeleton(nb::module_& room) {
  nb::class_<SkeletonInput>(room, "Skeleton", "Of sites only the scale needs no ends.")
      .def(nb::init<const Places&, const Vector<const double>&, const IndexRows&, const Places&,
                    const IndexRows&, const Vector<const double>&, const std::optional<Places>&,
                    const Vector<const std::uint8_t>&, bool, double>(),
           "vertices"_a, "radius"_a, "arcs"_a, "control"_a, "sites"_a, "length"_a, "site_ends"_a.none(),
           "is_anchored"_a, "has_gap"_a, "reach"_a);
  room.def("skeleton_edges", &skeleton_edges, "diagram"_a, "threads"_a, "progress"_a.none(),
           "Edges that are not deleted, and the face that each lies in.");
  room.def("extract_skeleton", &extract_skeleton, "diagram"_a, "kept"_a, "groups"_a, "clipped"_a.none(),
           "joined"_a, "origin_x"_a, "origin_y"_a, "scale"_a, "threads"_a, "progress"_a.none(),
           "Frames are least x, most x, least y, most y on the lattice, of group -1 for all; joined are groups from one to before "
           "another.");
  room.def("steps_along", &steps_along, "skeleton"_a, "first"_a, "counts"_a, "every"_a, "threads"_a,
           "progress"_a.none(), "Places at equal steps along branches, whose first arcs are given.");
  room.def("clearance_course", &clearance_course, "vertices"_a, "radius"_a, "arcs"_a, "sites"_a,
           "site_places"_a, "error"_a, "sites_are_exact"_a, "threads"_a, "progress"_a.none(),
           "How the clearance begins to change at the source and target of each arc, and where it is least; "
           "all on "
           "the lattice.");
}

}  // namespace vorotool::bindings
