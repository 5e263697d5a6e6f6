// Delaunay triangulation and its check.
#include <algorithm>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/mesh_arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/base/large_array.hpp"
#include "core/delaunay/delaunay_triangulation.hpp"
#include "core/delaunay/nearest_neighbours.hpp"
#include "core/delaunay/point_insertion.hpp"
#include "core/delaunay/verify_triangulation.hpp"

namespace vorotool::bindings {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using core::base::Monitor;
using core::delaunay::DelaunayTriangulation;
using core::kernel::Point;

auto copied(std::span<const std::int32_t> values) {
  core::base::LargeArray<std::int32_t> kept(values.size());
  std::copy(values.begin(), values.end(), kept.data());
  return to_numpy(std::move(kept), {values.size()});
}

void make_mesh(DelaunayTriangulation* self, const Matrix<const double>& array, unsigned threads,
               const Progress& progress) {
  const std::span<const Point> points = as_points(array);
  run_interruptible(
      progress, [&](const Monitor& monitor) { new (self) DelaunayTriangulation(points, threads, monitor); });
}

// Triangles, their neighbours, and edges.
auto arrays_of(const DelaunayTriangulation& mesh, unsigned threads, const Progress& progress) {
  const std::size_t rows = mesh.triangle_count();
  core::base::LargeArray<std::int32_t> triangles(3 * rows), neighbours(3 * rows),
      edges(2 * mesh.edge_count());
  run_interruptible(progress, [&](const Monitor& monitor) {
    mesh.write({triangles.data(), neighbours.data(), edges.data()}, threads, monitor);
  });
  return std::make_tuple(to_numpy(std::move(triangles), {rows, 3}),
                         to_numpy(std::move(neighbours), {rows, 3}),
                         to_numpy(std::move(edges), {mesh.edge_count(), 2}));
}

// Triangles, neighbours, edges, hull and first of the points of a mesh and further ones; None where the order
// of its triangles would change.
auto insert_points(const Matrix<const double>& points, const IndexRows& triangles,
                   const IndexRows& neighbours, const IndexRows& edges, const Indices& hull,
                   const Indices& first, const Indices& hints, unsigned threads, const Progress& progress) {
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
  const auto as_tuple = [](core::delaunay::InsertedArrays& arrays) {
    const std::size_t rows = arrays.triangles.size() / 3, links = arrays.edges.size() / 2;
    return std::make_tuple(to_numpy(std::move(arrays.triangles), {rows, 3}),
                           to_numpy(std::move(arrays.neighbours), {rows, 3}),
                           to_numpy(std::move(arrays.edges), {links, 2}), to_numpy(std::move(arrays.hull)),
                           to_numpy(std::move(arrays.first)));
  };
  return made ? std::optional(as_tuple(*made)) : std::nullopt;
}

// The nearest point of each, and its number of neighbours.
auto nearest_neighbours(const Matrix<const double>& points, const IndexRows& edges,
                        const Vector<const std::int64_t>& labels, const Progress& progress) {
  const std::span<const core::kernel::Point> sites = as_points(points);
  const std::span<const std::int32_t> ends = rows_of(edges, 2);
  if (labels.size() != sites.size()) throw std::invalid_argument("there must be one label a point");
  core::delaunay::NearestNeighbours found = run_interruptible(progress, [&](const Monitor& monitor) {
    return core::delaunay::nearest_neighbours(sites, ends, view(labels), monitor);
  });
  return std::make_tuple(to_numpy(std::move(found.nearest)), to_numpy(std::move(found.count)));
}

std::optional<std::string> find_fault(const Matrix<const double>& points, const IndexRows& triangles,
                                      const IndexRows& neighbours, const IndexRows& edges,
                                      const Indices& hull, const Indices& first, unsigned threads,
                                      const Progress& progress) {
  const core::delaunay::TriangulationArrays arrays =
      mesh_arrays(points, triangles, neighbours, rows_of(edges, 2), view(hull), view(first));
  return run_interruptible(
      progress, [&](const Monitor& monitor) { return core::delaunay::find_fault(arrays, threads, monitor); });
}

}  // namespace

void bind_delaunay(nb::module_& room) {
  nb::class_<DelaunayTriangulation>(room, "DelaunayTriangulation")
      .def("__init__", &make_mesh, "points"_a, "threads"_a, "progress"_a.none())
      .def_prop_ro("first", [](const DelaunayTriangulation& mesh) { return copied(mesh.first()); })
      .def_prop_ro("hull", [](const DelaunayTriangulation& mesh) { return copied(mesh.hull()); })
      .def("arrays", &arrays_of, "threads"_a, "progress"_a.none(), "Triangles, their neighbours, and edges.");
  room.def(
      "insert_points", &insert_points, "points"_a, "triangles"_a, "neighbours"_a, "edges"_a, "hull"_a,
      "first"_a, "hints"_a, "threads"_a, "progress"_a.none(),
      "Triangles, neighbours, edges, hull, first; None where the order of triangles that stay would change.");
  room.def("find_fault", &find_fault, "points"_a, "triangles"_a, "neighbours"_a, "edges"_a, "hull"_a,
           "first"_a, "threads"_a, "progress"_a.none());
  room.def("nearest_neighbours", &nearest_neighbours, "points"_a, "edges"_a, "labels"_a, "progress"_a.none(),
           "Index of the nearest point of each, -1 without any, and its number of neighbours.");
}

}  // namespace vorotool::bindings
