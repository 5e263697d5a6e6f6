// The segment Voronoi diagram, and its check.
#include <nanobind/stl/array.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/planar_graph.hpp"
#include "bindings/support/segment_diagram.hpp"
#include "core/segment_voronoi/build/segment_voronoi.hpp"
#include "core/segment_voronoi/build/wanted_faces.hpp"
#include "core/segment_voronoi/verify/verify_segment_voronoi.hpp"

namespace vorotool::bindings {
namespace {

using core::base::IndexPair;
using core::base::Monitor;
using core::kernel::LatticePoint;
using core::segment_voronoi::build::SegmentVoronoi;

// Least and most x, then least and most y.
core::spatial::Bounds bounds_of(const std::array<std::int32_t, 4>& within,
                                std::span<const LatticePoint> points) {
  const auto [least_x, most_x, least_y, most_y] = within;
  core::spatial::Bounds bounds({static_cast<double>(least_x), static_cast<double>(least_y)});
  bounds.add({static_cast<double>(most_x), static_cast<double>(most_y)});
  for (const LatticePoint& p : points) {
    if (bounds.holds({static_cast<double>(p.x), static_cast<double>(p.y)})) continue;
    throw std::invalid_argument("a point is beyond the bounds");
  }
  return bounds;
}

void make_diagram(SegmentVoronoi* self, const IndexRows& points, const IndexRows& segments, unsigned threads,
                  const Progress& progress, const std::optional<std::array<std::int32_t, 4>>& within) {
  check_coordinates(view(points));
  const core::kernel::PlanarGraphView graph{rows<LatticePoint>(points), rows<IndexPair>(segments), {}};
  std::optional<core::spatial::Bounds> bounds;
  if (within) bounds = bounds_of(*within, graph.points);
  run_interruptible(
      progress, [&](const Monitor& monitor) { new (self) SegmentVoronoi(graph, bounds, threads, monitor); });
}

Columns take_arrays(SegmentVoronoi& diagram, const std::optional<Vector<const std::uint8_t>>& unwanted,
                    unsigned threads, const Progress& progress) {
  const std::span<const std::uint8_t> sides = unwanted ? view(*unwanted) : std::span<const std::uint8_t>();
  core::segment_voronoi::build::Diagram made = run_interruptible(
      progress, [&](const Monitor& monitor) { return diagram.take_arrays(sides, threads, monitor); });
  const std::size_t vertices = made.radius.size(), ring = made.vertex_sites.size(),
                    edges = made.edges.size() / 2;
  Columns result;
  result["vertices"] = to_numpy(std::move(made.vertices), {vertices, 2});
  result["radius"] = to_numpy(std::move(made.radius), {vertices});
  result["vertex_starts"] = to_numpy(std::move(made.vertex_start), {vertices + 1});
  result["vertex_sites"] = to_numpy(std::move(made.vertex_sites), {ring});
  result["edges"] = to_numpy(std::move(made.edges), {edges, 2});
  result["edge_sites"] = to_numpy(std::move(made.edge_sites), {edges, 2});
  return result;
}

std::optional<std::string> fault_of_diagram(const SegmentDiagram& diagram, unsigned threads,
                                            const Progress& progress) {
  return run_interruptible(progress, core::segment_voronoi::verify::find_fault, diagram.unchecked(), threads);
}

// A byte a site.
auto unwanted_sides(const PlanarGraph& graph, const Vector<const std::uint8_t>& is_wanted) {
  core::base::check_range(graph.view().faces, 0, is_wanted.size(), "the face of a segment is out of range");
  return to_numpy(core::segment_voronoi::build::unwanted_sides(graph.view(), view(is_wanted)));
}

Columns diagram_counts(const SegmentVoronoi& diagram) {
  const core::segment_voronoi::build::SegmentVoronoiCounts& counts = diagram.counts();
  Columns result;
  result["visited"] = counts.visited;
  result["cyclic"] = counts.cyclic;
  result["integer"] = counts.escalations.integer;
  result["double_double"] = counts.escalations.double_double;
  result["exact"] = counts.escalations.exact;
  return result;
}

}  // namespace

void bind_segment_voronoi(nb::module_& room) {
  room.def("unwanted_sides", &unwanted_sides, "graph"_a, "is_wanted"_a);
  nb::class_<SegmentVoronoi>(room, "SegmentVoronoi")
      .def("__init__", &make_diagram, "points"_a, "segments"_a, "threads"_a, "progress"_a.none(),
           "within"_a = nb::none())
      .def_prop_ro("counts", &diagram_counts)
      .def("take_arrays", &take_arrays, "unwanted"_a.none(), "threads"_a, "progress"_a.none(),
           "The arrays of a Diagram that are not of its graph: once.");
  nb::class_<SegmentDiagram>(room, "Diagram")
      .def(nb::init<const IndexRows&, const IndexRows&, const Places&, const Vector<const double>&,
                    const Indices&, const Indices&, const IndexRows&, const IndexRows&,
                    const std::optional<IndexRows>&>(),
           "points"_a, "segments"_a, "vertices"_a, "radius"_a, "vertex_starts"_a, "vertex_sites"_a, "edges"_a,
           "edge_sites"_a, "segment_faces"_a.none());
  room.def("find_fault", &fault_of_diagram, "diagram"_a, "threads"_a, "progress"_a.none());
}

}  // namespace vorotool::bindings
