// Borders between sites of points, lines and polygons.
#include <optional>
#include <span>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/planar_graph.hpp"
#include "bindings/support/segment_diagram.hpp"
#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/voronoi/border_curves.hpp"
#include "core/voronoi/owners_at_points.hpp"
#include "core/voronoi/ring_ranks.hpp"
#include "core/voronoi/site_borders.hpp"

namespace vorotool::bindings {
namespace {

auto edge_faces(const SegmentDiagram& input, unsigned threads, const Progress& progress) {
  const core::segment_voronoi::build::DiagramView& diagram = input.view_with_faces();
  core::voronoi::EdgeFaces made =
      run_interruptible(progress, core::voronoi::edge_faces, diagram, core::base::resolve_threads(threads));
  const std::size_t edges = diagram.edges.size();
  return std::make_tuple(to_numpy(std::move(made.faces), {edges, 2}),
                         to_numpy(std::move(made.is_own), {edges}), to_numpy(std::move(made.alias)));
}

using NearAndCrowded = std::pair<Vector<const std::uint8_t>, Indices>;

Columns site_borders(const SegmentDiagram& input, const Indices& element_owner, const Indices& face_owner,
                     const std::optional<NearAndCrowded>& limits, unsigned threads,
                     const Progress& progress) {
  const core::segment_voronoi::build::DiagramView& diagram = input.view_with_faces();
  if (element_owner.size() != diagram.site_count())
    throw std::invalid_argument("each element must have an owner");
  core::base::check_range(diagram.faces, 0, face_owner.size(), "the face of a segment is out of range");
  if (face_owner.size() == 0) throw std::invalid_argument("the unbounded face must have an owner");
  std::optional<core::voronoi::Reach> reach;
  if (limits) {
    const auto& [is_near, crowded] = *limits;
    if (is_near.size() != diagram.edges.size()) throw std::invalid_argument("each edge must be near or not");
    core::base::check_range(view(crowded), 0, diagram.vertex_count(), "a vertex is out of range");
    reach = {view(is_near), view(crowded)};
  }
  core::voronoi::SiteBorders made =
      run_interruptible(progress, core::voronoi::site_borders, diagram, view(element_owner), view(face_owner),
                        reach, core::base::resolve_threads(threads));
  const std::size_t size = made.size();
  Columns result;
  result["ends"] = to_numpy(std::move(made.ends), {size, 2});
  result["elements"] = to_numpy(std::move(made.elements), {size, 2});
  result["sites"] = to_numpy(std::move(made.sites), {size, 2});
  result["parts"] = to_numpy(std::move(made.parts), {size, 2});
  result["order"] = to_numpy(std::move(made.order), {size, 2});
  result["added"] = to_numpy(std::move(made.added));
  if (reach) {
    result["edge"] = to_numpy(std::move(made.edge));
    result["point"] = to_numpy(std::move(made.point));
    result["is_first"] = to_numpy(std::move(made.is_first));
    result["root"] = to_numpy(std::move(made.root));
  }
  return result;
}

auto owners_at_points(const IndexRows& segments, const Indices& owner, std::size_t points) {
  const auto pairs = rows<core::base::IndexPair>(segments);
  if (owner.size() != pairs.size()) throw std::invalid_argument("each segment must have an owner");
  core::base::check_range(pairs, 0, points, "an end of a segment is out of range");
  core::voronoi::OwnersAtPoints made = core::voronoi::owners_at_points(pairs, view(owner), points);
  return std::make_tuple(to_numpy(std::move(made.least)), to_numpy(std::move(made.most)));
}

using Numbers = Matrix<const std::int64_t>;

void check_numbers(std::span<const std::int64_t> numbers, std::size_t end, const char* what) {
  for (const std::int64_t number : numbers) {
    if (number < -1 || number >= static_cast<std::int64_t>(end)) throw std::invalid_argument(what);
  }
}

auto ranks_around(const SegmentDiagram& input, const Vector<const std::int64_t>& vertex,
                  const Vector<const std::int64_t>& site) {
  const core::segment_voronoi::build::DiagramView& diagram = input.view();
  if (vertex.size() != site.size()) throw std::invalid_argument("each vertex must have a site");
  check_numbers(view(vertex), diagram.vertex_count(), "a vertex is out of range");
  return to_numpy(core::voronoi::ranks_around(diagram, view(vertex), view(site)));
}

auto control_points(const PlanarGraph& graph, const Numbers& ends, const Numbers& elements,
                    const Places& places, const Vector<const double>& radius, unsigned threads,
                    const Progress& progress) {
  const std::size_t size = ends.size() / 2;
  if (elements.size() != ends.size() || radius.size() != places.shape(0)) {
    throw std::invalid_argument("the arrays of borders have lengths that do not go together");
  }
  check_numbers(view(ends), radius.size(), "an end of a border is out of range");
  check_numbers(view(elements), graph.view().site_count(), "an element of a border is out of range");
  core::base::LargeArray<double> made = run_interruptible(
      progress, core::voronoi::control_points, graph.view(), view(ends), view(elements),
      rows<core::kernel::Point>(places), view(radius), core::base::resolve_threads(threads));
  return to_numpy(std::move(made), {size, 2});
}

}  // namespace

void bind_voronoi(nb::module_& room) {
  room.def(
      "site_borders", &site_borders, "diagram"_a, "element_owner"_a, "face_owner"_a, "limits"_a.none(),
      "threads"_a, "progress"_a.none(),
      "Ends, elements, sites, parts and order of borders, and the points that became nodes after vertices.");
  room.def("edge_faces", &edge_faces, "diagram"_a, "threads"_a, "progress"_a.none(),
           "In which face each edge begins and ends; whether it is between a segment and its own end; of "
           "points the segment that has their cell.");
  room.def("ranks_around", &ranks_around, "diagram"_a, "vertex"_a, "site"_a,
           "The places of sites among those around vertices.");
  room.def("owners_at_points", &owners_at_points, "segments"_a, "owner"_a, "points"_a,
           "The smallest and the largest owner of the segments that end at each point.");
  room.def("control_points", &control_points, "graph"_a, "ends"_a, "elements"_a, "places"_a, "radius"_a,
           "threads"_a, "progress"_a.none(), "Of the Bezier curves that borders are; NaN of straight lines.");
}

}  // namespace vorotool::bindings
