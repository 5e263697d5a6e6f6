// The segment Voronoi diagram.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "core/segment_voronoi.hpp"
#include "interrupts.hpp"

namespace vorotool::bindings {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using core::LatticePoint;
using core::Monitor;
using core::SegmentVoronoi;
using Rows = Matrix<const std::int32_t>;

std::span<const LatticePoint> as_points(const Rows& array) {
  if (array.shape(1) != 2) throw std::invalid_argument("points must have two columns");
  for (const std::int32_t value : view(array)) {
    if (std::abs(std::int64_t{value}) > core::lattice_limit) {
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

void make_diagram(SegmentVoronoi* self, const Rows& points, const Rows& segments, unsigned threads,
                  nb::handle progress) {
  const core::SegmentGraph graph{as_points(points), as_segments(segments)};
  run_interruptible(progress,
                    [&](const Monitor& monitor) { new (self) SegmentVoronoi(graph, threads, monitor); });
}

// Vertices, radii, where their sites begin, their sites, edges, and the sites of these.
nb::tuple take_arrays(SegmentVoronoi& diagram, unsigned threads, nb::handle progress) {
  core::DiagramArrays made = run_interruptible(
      progress, [&](const Monitor& monitor) { return diagram.take_arrays(threads, monitor); });
  const std::size_t vertices = made.radius.size(), ring = made.vertex_sites.size(),
                    edges = made.edges.size() / 2;
  return nb::make_tuple(
      to_numpy(std::move(made.vertices), {vertices, 2}), to_numpy(std::move(made.radius), {vertices}),
      to_numpy(std::move(made.vertex_start), {vertices + 1}), to_numpy(std::move(made.vertex_sites), {ring}),
      to_numpy(std::move(made.edges), {edges, 2}), to_numpy(std::move(made.edge_sites), {edges, 2}));
}

nb::dict counts_of(const SegmentVoronoi& diagram) {
  const core::SegmentVoronoiCounts& counts = diagram.counts();
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
  nb::class_<SegmentVoronoi>(module, "SegmentVoronoi")
      .def("__init__", &make_diagram, "points"_a.noconvert(), "segments"_a.noconvert(), "threads"_a,
           "progress"_a.none())
      .def_prop_ro("counts", &counts_of)
      .def("take_arrays", &take_arrays, "threads"_a, "progress"_a.none());
}

}  // namespace vorotool::bindings
