// Delaunay triangulation and its check.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "core/base/large_array.hpp"
#include "core/delaunay/delaunay_triangulation.hpp"
#include "core/delaunay/point_insertion.hpp"
#include "core/delaunay/verify_triangulation.hpp"
#include "interrupts.hpp"
#include "mesh_arrays.hpp"

namespace vorotool::bindings {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using core::base::Monitor;
using core::delaunay::DelaunayTriangulation;
using core::kernel::Point;

nb::object copied(std::span<const std::int32_t> values) {
  core::base::LargeArray<std::int32_t> kept(values.size());
  std::copy(values.begin(), values.end(), kept.data());
  return to_numpy(std::move(kept), {values.size()});
}

void make_mesh(DelaunayTriangulation* self, const Matrix<const double>& array, unsigned threads,
               nb::handle progress) {
  const std::span<const Point> points = as_points(array);
  run_interruptible(
      progress, [&](const Monitor& monitor) { new (self) DelaunayTriangulation(points, threads, monitor); });
}

// Triangles, their neighbours, and edges.
nb::tuple arrays_of(const DelaunayTriangulation& mesh, unsigned threads, nb::handle progress) {
  const std::size_t rows = mesh.triangle_count();
  core::base::LargeArray<std::int32_t> triangles(3 * rows), neighbours(3 * rows),
      edges(2 * mesh.edge_count());
  run_interruptible(progress, [&](const Monitor& monitor) {
    mesh.write({triangles.data(), neighbours.data(), edges.data()}, threads, monitor);
  });
  return nb::make_tuple(to_numpy(std::move(triangles), {rows, 3}), to_numpy(std::move(neighbours), {rows, 3}),
                        to_numpy(std::move(edges), {mesh.edge_count(), 2}));
}

// Triangles, neighbours, edges, hull and first of the points of a mesh and further ones; None where the order
// of its triangles would change.
nb::object insert_points(const Matrix<const double>& points, const IndexRows& triangles,
                         const IndexRows& neighbours, const IndexRows& edges, const Indices& hull,
                         const Indices& first, const Indices& hints, unsigned threads, nb::handle progress) {
  const std::span<const Point> all = as_points(points);
  const core::delaunay::TriangulationArrays mesh{all.first(std::min(first.size(), all.size())),
                                                 rows_of(triangles, 3),
                                                 rows_of(neighbours, 3),
                                                 rows_of(edges, 2),
                                                 view(hull),
                                                 view(first)};
  if (first.size() > all.size() || neighbours.size() != triangles.size() ||
      (hints.size() != 0 && hints.size() != all.size() - first.size())) {
    throw std::invalid_argument("the arrays of a triangulation have lengths that do not go together");
  }
  std::optional<core::delaunay::InsertedArrays> made =
      run_interruptible(progress, [&](const Monitor& monitor) {
        return core::delaunay::insert_points(mesh, all, view(hints), threads, monitor);
      });
  if (!made) return nb::none();
  const std::size_t rows = made->triangles.size() / 3, links = made->edges.size() / 2;
  return nb::make_tuple(to_numpy(std::move(made->triangles), {rows, 3}),
                        to_numpy(std::move(made->neighbours), {rows, 3}),
                        to_numpy(std::move(made->edges), {links, 2}), to_numpy(std::move(made->hull)),
                        to_numpy(std::move(made->first)));
}

std::optional<std::string> triangulation_fault(const Matrix<const double>& points, const IndexRows& triangles,
                                               const IndexRows& neighbours, const IndexRows& edges,
                                               const Indices& hull, const Indices& first, unsigned threads,
                                               nb::handle progress) {
  const core::delaunay::TriangulationArrays arrays =
      mesh_arrays(points, triangles, neighbours, rows_of(edges, 2), view(hull), view(first));
  return run_interruptible(
      progress, [&](const Monitor& monitor) { return core::delaunay::find_fault(arrays, threads, monitor); });
}

}  // namespace

void bind_delaunay(nb::module_& module) {
  nb::class_<DelaunayTriangulation>(module, "DelaunayTriangulation")
      .def("__init__", &make_mesh, "points"_a.noconvert(), "threads"_a, "progress"_a.none())
      .def_prop_ro("first", [](const DelaunayTriangulation& mesh) { return copied(mesh.first()); })
      .def_prop_ro("hull", [](const DelaunayTriangulation& mesh) { return copied(mesh.hull()); })
      .def("arrays", &arrays_of, "threads"_a, "progress"_a.none());
  module.def("insert_points", &insert_points, "points"_a.noconvert(), "triangles"_a.noconvert(),
             "neighbours"_a.noconvert(), "edges"_a.noconvert(), "hull"_a.noconvert(), "first"_a.noconvert(),
             "hints"_a.noconvert(), "threads"_a, "progress"_a.none());
  module.def("triangulation_fault", &triangulation_fault, "points"_a.noconvert(), "triangles"_a.noconvert(),
             "neighbours"_a.noconvert(), "edges"_a.noconvert(), "hull"_a.noconvert(), "first"_a.noconvert(),
             "threads"_a, "progress"_a.none());
}

}  // namespace vorotool::bindings
