// Placement on the lattice, the planar graph of polygons and lines, and its check.
#include <algorithm>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/planar_graph.hpp"
#include "core/arrangement/boundary_rings.hpp"
#include "core/arrangement/lattice_placement.hpp"
#include "core/arrangement/planar_graph.hpp"
#include "core/arrangement/segment_set.hpp"
#include "core/arrangement/sound_polygons.hpp"
#include "core/arrangement/verify_planar_graph.hpp"

namespace vorotool::bindings {
namespace {

using core::base::IndexPair;
using core::base::Monitor;
using core::kernel::LatticePoint;

// An (n, 2) array of the values, which come in pairs.
auto pairs(std::span<const std::int32_t> values) {
  core::base::LargeArray<std::int32_t> kept(values.size());
  std::copy(values.begin(), values.end(), kept.data());
  return to_numpy(std::move(kept), {values.size() / 2, 2});
}

auto pairs(const std::vector<LatticePoint>& points) {
  return pairs({reinterpret_cast<const std::int32_t*>(points.data()), 2 * points.size()});
}

// Lattice points, origin, exponent and the largest move.
auto place_on_lattice(const Places& array, unsigned threads, const Progress& progress) {
  const auto points = rows<core::kernel::Point>(array);
  const core::arrangement::Placement placed =
      run_interruptible(progress, core::arrangement::place_on_lattice, points, threads);
  return std::make_tuple(pairs(placed.points), std::make_tuple(placed.origin_x, placed.origin_y),
                         placed.exponent, placed.largest_move);
}

auto first_at_place(const IndexRows& points, const Progress& progress) {
  const std::span<const LatticePoint> vertices = rows<LatticePoint>(points);
  return to_numpy(run_interruptible(progress, core::arrangement::first_at_place, vertices));
}

Columns make_planar_graph(const IndexRows& array, const Vector<const std::int64_t>& ring_start,
                          const Vector<const std::int8_t>& ring_kind, const Indices& ring_polygon,
                          const Progress& progress) {
  const std::span<const LatticePoint> vertices = rows<LatticePoint>(array);
  const core::arrangement::Rings rings{view(ring_start), view(ring_kind), view(ring_polygon)};
  if (rings.start.size() != rings.kind.size() + 1 || rings.kind.size() != rings.polygon.size() ||
      static_cast<std::size_t>(rings.start.back()) != vertices.size()) {
    throw std::invalid_argument("the arrays of rings have lengths that do not go together");
  }
  core::arrangement::PlanarGraph graph =
      run_interruptible(progress, core::arrangement::make_planar_graph, vertices, rings);
  Columns result;
  result["points"] = pairs(graph.points);
  result["point_vertex"] = to_numpy(std::move(graph.point_vertex));
  result["segments"] = two_columns(std::move(graph.segments));
  result["source_starts"] = to_numpy(std::move(graph.source_start));
  result["source_edge"] = to_numpy(std::move(graph.source_edge));
  result["segment_faces"] = two_columns(std::move(graph.segment_faces));
  result["face_starts"] = to_numpy(std::move(graph.face_polygons.start));
  result["face_polygon"] = to_numpy(std::move(graph.face_polygons.polygon));
  result["point_holes"] = to_numpy(std::move(graph.point_holes));
  nb::list repairs;
  for (const core::arrangement::RepairCount& repair : graph.repairs) {
    repairs.append(nb::make_tuple(repair.count, repair.edge, repair.other));
  }
  result["repairs"] = repairs;
  result["is_repaired"] = to_numpy(std::move(graph.is_repaired));
  return result;
}

Columns boundary_rings(const PlanarGraph& graph, const Indices& face_start, const Indices& face_polygon,
                       const Progress& progress) {
  if (face_start.size() == 0) throw std::invalid_argument("a planar graph has one face at least");
  core::arrangement::BoundaryRings rings = run_interruptible(progress, [&](const Monitor&) {
    return core::arrangement::find_boundary_rings(graph.view(), view(face_start), view(face_polygon));
  });
  Columns result;
  result["start"] = to_numpy(std::move(rings.start));
  result["point"] = to_numpy(std::move(rings.point));
  result["segment"] = to_numpy(std::move(rings.segment));
  result["is_hole"] = to_numpy(std::move(rings.is_hole));
  result["ring_part"] = to_numpy(std::move(rings.ring_part));
  result["part_polygon"] = to_numpy(std::move(rings.part_polygon));
  return result;
}

std::optional<std::string> fault_of_graph(const IndexRows& points, const IndexRows& segments,
                                          const std::optional<IndexRows>& faces, const Progress& progress) {
  core::kernel::PlanarGraphView graph{rows<LatticePoint>(points), rows<IndexPair>(segments), {}};
  if (faces) graph.faces = rows<IndexPair>(*faces);
  if (faces && graph.faces.size() != graph.segments.size())
    throw std::invalid_argument("each segment must have two faces");
  return run_interruptible(progress, core::arrangement::find_fault, graph);
}

auto polygon_faults(const Places& points, const Vector<const std::int64_t>& ring_start,
                    const Vector<const std::int64_t>& polygon_start, bool is_coverage, unsigned threads,
                    const Progress& progress) {
  const core::arrangement::PolygonRings rings{rows<core::kernel::Point>(points), view(ring_start),
                                              view(polygon_start)};
  const auto divides = [](std::span<const std::int64_t> starts, std::size_t size) {
    return !starts.empty() && starts.front() == 0 && std::is_sorted(starts.begin(), starts.end()) &&
           static_cast<std::size_t>(starts.back()) == size;
  };
  if (!divides(rings.ring_start, rings.points.size()) ||
      !divides(rings.polygon_start, rings.ring_start.size() - 1)) {
    throw std::invalid_argument("the arrays of rings have lengths that do not go together");
  }
  return to_numpy(run_interruptible(progress, [&](const Monitor& monitor) {
    return core::arrangement::find_polygon_faults(rings, is_coverage, threads, monitor);
  }));
}

}  // namespace

void bind_arrangement(nb::module_& room) {
  nb::exception<core::arrangement::TooManyCrossings>(room, "TooManyCrossingsError", PyExc_ValueError);
  nb::exception<core::arrangement::TooManyOverlaps>(room, "TooManyOverlapsError", PyExc_ValueError);
  room.def("place_on_lattice", &place_on_lattice, "points"_a, "threads"_a, "progress"_a.none(),
           "Lattice points, origin, exponent of the step and the largest move; the points must be finite.");
  room.def("first_at_place", &first_at_place, "points"_a, "progress"_a.none(),
           "For each lattice point the smallest index of one at the same place.");
  room.def("make_planar_graph", &make_planar_graph, "vertices"_a, "ring_starts"_a, "ring_kind"_a,
           "ring_polygon"_a, "progress"_a.none(),
           "Arrays of a PlanarGraph; repairs: of each kind the count, an edge, and what meets it or -1.");
  room.def("boundary_rings", &boundary_rings, "graph"_a, "face_starts"_a, "face_polygon"_a,
           "progress"_a.none(), "The indices of faces must be in range.");
  room.def("polygon_faults", &polygon_faults, "points"_a, "ring_starts"_a, "polygon_starts"_a,
           "is_coverage"_a, "threads"_a, "progress"_a.none(),
           "Of each polygon 1 if it is not seen to be one simple ring, 2 if it clashes with others of its "
           "coverage.");
  room.def("find_fault", &fault_of_graph, "points"_a, "segments"_a, "faces"_a.none(), "progress"_a.none());
}

}  // namespace vorotool::bindings
