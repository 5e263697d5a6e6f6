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
#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/skeleton/clearance_course.hpp"
#include "core/skeleton/edges.hpp"
#include "core/skeleton/extraction.hpp"

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
  room.def("skeleton_edges", &skeleton_edges, "diagram"_a, "threads"_a, "progress"_a.none(),
           "Edges that are not deleted, and the face that each lies in.");
  room.def("extract_skeleton", &extract_skeleton, "diagram"_a, "kept"_a, "groups"_a, "clipped"_a.none(),
           "joined"_a, "origin_x"_a, "origin_y"_a, "scale"_a, "threads"_a, "progress"_a.none(),
           "Frames are least x, most x, least y, most y on the lattice; joined are groups from one to before "
           "another.");
  room.def("clearance_course", &clearance_course, "vertices"_a, "radius"_a, "arcs"_a, "sites"_a,
           "site_places"_a, "error"_a, "sites_are_exact"_a, "threads"_a, "progress"_a.none(),
           "How the clearance begins to change at the source and target of each arc, and where it is least; "
           "all on "
           "the lattice.");
}

}  // namespace vorotool::bindings
