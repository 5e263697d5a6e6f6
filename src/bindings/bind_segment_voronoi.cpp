// The segment Voronoi diagram.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "core/segment_voronoi/build/segment_voronoi.hpp"
#include "core/segment_voronoi/build/wanted_faces.hpp"
#include "interrupts.hpp"

namespace vorotool::bindings {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using core::base::Monitor;
using core::kernel::LatticePoint;
using core::segment_voronoi::build::SegmentVoronoi;
using Rows = Matrix<const std::int32_t>;

std::span<const LatticePoint> as_points(const Rows& array) {
  if (array.shape(1) != 2) throw std::invalid_argument("points must have two columns");
  for (const std::int32_t value : view(array)) {
    if (std::abs(std::int64_t{value}) > core::kernel::lattice_limit) {
      throw std::invalid_argument("coordinate " + std::to_string(value) + " is beyond the lattice");
    }
  }
  static_assert(sizeof(LatticePoint) == 2 * sizeof(std::int32_t));
  return {reinterpret_cast<const LatticePoint*>(array.data()), array.shape(0)};
}

std::span<const std::array<std::int32_t, 2>> as_segments(const Rows& array) {
  if (array.shape(1) != 2) throw std::invalid_argument("segments must have two columns");
  return {reinterpret_cast<const std::array<std::int32_t, 2>*>(array.data()), array.shape(0)};
}

void check_range(std::span<const std::array<std::int32_t, 2>> pairs, std::size_t count) {
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

void make_diagram(SegmentVoronoi* self, const Rows& points, const Rows& segments, unsigned threads,
                  nb::handle progress, const std::optional<std::array<std::int32_t, 4>>& within) {
  const core::kernel::PlanarGraphView graph{as_points(points), as_segments(segments), {}};
  std::optional<core::spatial::Bounds> bounds;
  if (within) bounds = bounds_of(*within, graph.points);
  run_interruptible(
      progress, [&](const Monitor& monitor) { new (self) SegmentVoronoi(graph, bounds, threads, monitor); });
}

// Vertices, radii, where their sites begin, their sites, edges, and the sites of these.
nb::tuple take_arrays(SegmentVoronoi& diagram, const std::optional<Vector<const std::uint8_t>>& unwanted,
                      unsigned threads, nb::handle progress) {
  const std::span<const std::uint8_t> sides = unwanted ? view(*unwanted) : std::span<const std::uint8_t>();
  core::segment_voronoi::build::Diagram made = run_interruptible(
      progress, [&](const Monitor& monitor) { return diagram.take_arrays(sides, threads, monitor); });
  const std::size_t vertices = made.radius.size(), ring = made.vertex_sites.size(),
                    edges = made.edges.size() / 2;
  return nb::make_tuple(
      to_numpy(std::move(made.vertices), {vertices, 2}), to_numpy(std::move(made.radius), {vertices}),
      to_numpy(std::move(made.vertex_start), {vertices + 1}), to_numpy(std::move(made.vertex_sites), {ring}),
      to_numpy(std::move(made.edges), {edges, 2}), to_numpy(std::move(made.edge_sites), {edges, 2}));
}

// A byte a site.
nb::object unwanted_sides(const Rows& points, const Rows& segments, const Rows& segment_faces,
                          const Vector<const std::uint8_t>& is_wanted) {
  const auto faces = as_segments(segment_faces);
  if (faces.size() != segments.shape(0)) throw std::invalid_argument("each segment must have two faces");
  check_range(as_segments(segments), points.shape(0));
  check_range(faces, is_wanted.size());
  return to_numpy(core::segment_voronoi::build::unwanted_sides(
      {as_points(points), as_segments(segments), faces}, view(is_wanted)));
}

nb::dict counts_of(const SegmentVoronoi& diagram) {
  const core::segment_voronoi::build::SegmentVoronoiCounts& counts = diagram.counts();
  nb::dict result;
  result["visited"] = counts.visited;
  result["cyclic"] = counts.cyclic;
  result["integer"] = counts.escalations.integer;
  result["double_double"] = counts.escalations.double_double;
  result["exact"] = counts.escalations.exact;
  return result;
}

}  // namespace

void bind_segment_voronoi(nb::module_& module) {
  module.def("unwanted_sides", &unwanted_sides, "points"_a.noconvert(), "segments"_a.noconvert(),
             "segment_faces"_a.noconvert(), "is_wanted"_a.noconvert());
  nb::class_<SegmentVoronoi>(module, "SegmentVoronoi")
      .def("__init__", &make_diagram, "points"_a.noconvert(), "segments"_a.noconvert(), "threads"_a,
           "progress"_a.none(), "within"_a = nb::none())
      .def_prop_ro("counts", &counts_of)
      .def("take_arrays", &take_arrays, "unwanted"_a.none(), "threads"_a, "progress"_a.none());
}

}  // namespace vorotool::bindings
