// The segment Voronoi diagram, and its check.
#include <nanobind/stl/array.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/diagram_arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/segment_voronoi/build/segment_voronoi.hpp"
#include "core/segment_voronoi/build/wanted_faces.hpp"
#include "core/segment_voronoi/verify/verify_segment_voronoi.hpp"

namespace vorotool::bindings {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using core::base::Monitor;
using core::segment_voronoi::build::SegmentVoronoi;

std::span<const LatticePoint> as_points(const IndexRows& array) {
  for (const std::int32_t value : view(array)) {
    if (std::abs(std::int64_t{value}) > core::kernel::lattice_limit) {
      throw std::invalid_argument("coordinate " + std::to_string(value) + " is beyond the lattice");
    }
  }
  return rows<LatticePoint>(array);
}

void check_range(std::span<const Pair> pairs, std::size_t count) {
  for (const auto& pair : pairs) {
    for (const std::int32_t index : pair) {
      if (index < 0 || static_cast<std::size_t>(index) >= count) {
        throw std::invalid_argument("an index of the graph is out of range");
      }
    }
  }
}

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
  const core::kernel::PlanarGraphView graph{as_points(points), rows<Pair>(segments), {}};
  std::optional<core::spatial::Bounds> bounds;
  if (within) bounds = bounds_of(*within, graph.points);
  run_interruptible(
      progress, [&](const Monitor& monitor) { new (self) SegmentVoronoi(graph, bounds, threads, monitor); });
}

// Vertices, radii, where their sites begin, their sites, edges, and the sites of these.
auto take_arrays(SegmentVoronoi& diagram, const std::optional<Vector<const std::uint8_t>>& unwanted,
                 unsigned threads, const Progress& progress) {
  const std::span<const std::uint8_t> sides = unwanted ? view(*unwanted) : std::span<const std::uint8_t>();
  core::segment_voronoi::build::Diagram made = run_interruptible(
      progress, [&](const Monitor& monitor) { return diagram.take_arrays(sides, threads, monitor); });
  const std::size_t vertices = made.radius.size(), ring = made.vertex_sites.size(),
                    edges = made.edges.size() / 2;
  return std::make_tuple(
      to_numpy(std::move(made.vertices), {vertices, 2}), to_numpy(std::move(made.radius), {vertices}),
      to_numpy(std::move(made.vertex_start), {vertices + 1}), to_numpy(std::move(made.vertex_sites), {ring}),
      to_numpy(std::move(made.edges), {edges, 2}), to_numpy(std::move(made.edge_sites), {edges, 2}));
}

std::optional<std::string> find_fault(const IndexRows& points, const IndexRows& segments,
                                      const Places& vertices, const Vector<const double>& radius,
                                      const Vector<const std::int32_t>& vertex_start,
                                      const Vector<const std::int32_t>& vertex_sites, const IndexRows& edges,
                                      const IndexRows& edge_sites, unsigned threads,
                                      const Progress& progress) {
  const core::segment_voronoi::build::DiagramView arrays{
      {rows<LatticePoint>(points), rows<Pair>(segments), {}},
      rows<core::kernel::Point>(vertices),
      view(radius),
      rows<Pair>(edges),
      rows<Pair>(edge_sites),
      view(vertex_start),
      view(vertex_sites)};
  if (arrays.vertices.size() != arrays.radius.size() ||
      arrays.vertex_start.size() != arrays.radius.size() + 1 ||
      arrays.edge_sites.size() != arrays.edges.size()) {
    throw std::invalid_argument("the arrays of a diagram have lengths that do not go together");
  }
  return run_interruptible(progress, [&](const Monitor& monitor) {
    return core::segment_voronoi::verify::find_fault(arrays, threads, monitor);
  });
}

// A byte a site.
auto unwanted_sides(const IndexRows& points, const IndexRows& segments, const IndexRows& segment_faces,
                    const Vector<const std::uint8_t>& is_wanted) {
  const auto faces = rows<Pair>(segment_faces);
  if (faces.size() != segments.shape(0)) throw std::invalid_argument("each segment must have two faces");
  check_range(rows<Pair>(segments), points.shape(0));
  check_range(faces, is_wanted.size());
  return to_numpy(core::segment_voronoi::build::unwanted_sides(
      {as_points(points), rows<Pair>(segments), faces}, view(is_wanted)));
}

Columns counts_of(const SegmentVoronoi& diagram) {
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
  room.def("unwanted_sides", &unwanted_sides, "points"_a, "segments"_a, "segment_faces"_a, "is_wanted"_a);
  nb::class_<SegmentVoronoi>(room, "SegmentVoronoi")
      .def("__init__", &make_diagram, "points"_a, "segments"_a, "threads"_a, "progress"_a.none(),
           "within"_a = nb::none())
      .def_prop_ro("counts", &counts_of)
      .def("take_arrays", &take_arrays, "unwanted"_a.none(), "threads"_a, "progress"_a.none(),
           "Vertices, radii, where the sites of each begin, these, edges, and the sites beside them: once.");
  room.def("find_fault", &find_fault, "points"_a, "segments"_a, "vertices"_a, "radius"_a, "vertex_start"_a,
           "vertex_sites"_a, "edges"_a, "edge_sites"_a, "threads"_a, "progress"_a.none());
}

}  // namespace vorotool::bindings
