// The check of a segment Voronoi diagram.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <array>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "arrays.hpp"
#include "bindings.hpp"
#include "core/segment_voronoi/verify/verify_segment_voronoi.hpp"
#include "interrupts.hpp"

namespace vorotool::bindings {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using core::base::Monitor;
using IndexPairs = Aligned<const std::int32_t, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Centres = Aligned<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Pair = std::array<std::int32_t, 2>;

std::span<const Pair> pairs(const IndexPairs& array) {
  static_assert(sizeof(Pair) == 2 * sizeof(std::int32_t));
  return {reinterpret_cast<const Pair*>(array.data()), array.shape(0)};
}

std::span<const core::kernel::Point> centres(const Centres& array) {
  static_assert(sizeof(core::kernel::Point) == 2 * sizeof(double));
  return {reinterpret_cast<const core::kernel::Point*>(array.data()), array.shape(0)};
}

std::span<const core::kernel::LatticePoint> lattice_points(const IndexPairs& array) {
  static_assert(sizeof(core::kernel::LatticePoint) == 2 * sizeof(std::int32_t));
  return {reinterpret_cast<const core::kernel::LatticePoint*>(array.data()), array.shape(0)};
}

std::optional<std::string> segment_voronoi_fault(const IndexPairs& points, const IndexPairs& segments,
                                                 const Centres& vertices, const Vector<const double>& radius,
                                                 const Vector<const std::int32_t>& vertex_start,
                                                 const Vector<const std::int32_t>& vertex_sites,
                                                 const IndexPairs& edges, const IndexPairs& edge_sites,
                                                 unsigned threads, nb::handle progress) {
  const core::segment_voronoi::build::DiagramView arrays{{lattice_points(points), pairs(segments), {}},
                                                         centres(vertices),
                                                         view(radius),
                                                         pairs(edges),
                                                         pairs(edge_sites),
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

}  // namespace

void bind_segment_verification(nb::module_& module) {
  module.def("segment_voronoi_fault", &segment_voronoi_fault, "points"_a.noconvert(),
             "segments"_a.noconvert(), "vertices"_a.noconvert(), "radius"_a.noconvert(),
             "vertex_start"_a.noconvert(), "vertex_sites"_a.noconvert(), "edges"_a.noconvert(),
             "edge_sites"_a.noconvert(), "threads"_a, "progress"_a.none());
}

}  // namespace vorotool::bindings
