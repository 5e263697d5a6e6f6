// Delaunay triangulation and its check.
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/triangulation.hpp"
#include "core/base/large_array.hpp"
#include "core/delaunay/delaunay_triangulation.hpp"
#include "core/delaunay/nearest_neighbors.hpp"
#include "core/delaunay/point_insertion.hpp"
#include "core/delaunay/verify_triangulation.hpp"

namespace vorotool::bindings {
namespace {

using core::base::Monitor;
using core::delaunay::DelaunayTriangulation;
using core::kernel::Point;

Columns as_dict(core::delaunay::InsertedArrays&& made) {
  const std::size_t triangles = made.triangles.size() / 3, edges = made.edges.size() / 2;
  Columns result;
  result["triangles"] = to_numpy(std::move(made.triangles), {triangles, 3});
  result["neighbors"] = to_numpy(std::move(made.neighbors), {triangles, 3});
  result["edges"] = to_numpy(std::move(made.edges), {edges, 2});
  result["hull"] = to_numpy(std::move(made.hull));
  result["first"] = to_numpy(std::move(made.first));
  return result;
}

void make_mesh(DelaunayTriangulation* self, const Places& array, unsigned threads, const Progress& progress) {
  const std::span<const Point> points = rows<Point>(array);
  run_interruptible(
      progress, [&](const Monitor& monitor) { new (self) DelaunayTriangulation(points, threads, monitor); });
}

Columns arrays_of(const DelaunayTriangulation& mesh, unsigned threads, const Progress& progress) {
  using Numbers = core::base::LargeArray<std::int32_t>;
  const std::size_t corners = 3 * mesh.triangle_count();
  core::delaunay::InsertedArrays made{Numbers(corners),
                                      Numbers(corners),
                                      Numbers(2 * mesh.edge_count()),
                                      {mesh.hull().begin(), mesh.hull().end()},
                                      {mesh.first().begin(), mesh.first().end()}};
  run_interruptible(progress, [&](const Monitor& monitor) {
    mesh.write({made.triangles.data(), made.neighbors.data(), made.edges.data()}, threads, monitor);
  });
  return as_dict(std::move(made));
}

// The arrays of a mesh of its points and further ones; None where the order of its triangles would change.
std::optional<Columns> insert_points(const Triangulation& mesh, const Places& points, const Indices& hints,
                                     unsigned threads, const Progress& progress) {
  const std::span<const Point> all = rows<Point>(points);
  const std::size_t count = mesh.view().points.size();
  if (count > all.size() || (hints.size() != 0 && hints.size() != all.size() - count))
    throw std::invalid_argument("points, or hints, are not as many as there must be");
  std::optional<core::delaunay::InsertedArrays> made =
      run_interruptible(progress, core::delaunay::insert_points, mesh.view(), all, view(hints), threads);
  return made ? std::optional(as_dict(std::move(*made))) : std::nullopt;
}

// The nearest point of each, and its number of neighbors.
auto nearest_neighbors(const Places& points, const IndexRows& edges, const Vector<const std::int64_t>& labels,
                       const Progress& progress) {
  const std::span<const Point> sites = rows<Point>(points);
  const std::span<const std::int32_t> ends = rows_of(edges, 2);
  if (labels.size() != sites.size()) throw std::invalid_argument("there must be one label a point");
  core::delaunay::NearestNeighbors found =
      run_interruptible(progress, core::delaunay::nearest_neighbors, sites, ends, view(labels));
  return std::make_tuple(to_numpy(std::move(found.nearest)), to_numpy(std::move(found.count)));
}

std::optional<std::string> fault_of_mesh(const Triangulation& mesh, unsigned threads,
                                         const Progress& progress) {
  return run_interruptible(progress, core::delaunay::find_fault, mesh.view(), threads);
}

}  // namespace

void bind_delaunay(nb::module_& room) {
  nb::class_<DelaunayTriangulation>(room, "DelaunayTriangulation")
      .def("__init__", &make_mesh, "points"_a, "threads"_a, "progress"_a.none())
      .def("arrays", &arrays_of, "threads"_a, "progress"_a.none(),
           "The arrays of a Triangulation but its points.");
  nb::class_<Triangulation>(room, "Triangulation")
      .def(nb::init<const Places&, const IndexRows&, const IndexRows&, const IndexRows&, const Indices&,
                    const Indices&>(),
           "points"_a, "triangles"_a, "neighbors"_a, "edges"_a, "hull"_a, "first"_a);
  room.def("insert_points", &insert_points, "mesh"_a, "points"_a, "hints"_a, "threads"_a, "progress"_a.none(),
           "Of the points of the mesh and further ones triangles, neighbors, edges, hull and first; None "
           "where the order of triangles that stay would change.");
  room.def("find_fault", &fault_of_mesh, "mesh"_a, "threads"_a, "progress"_a.none());
  room.def("nearest_neighbors", &nearest_neighbors, "points"_a, "edges"_a, "labels"_a, "progress"_a.none(),
           "Index of the nearest point of each, -1 without any, and its number of neighbors.");
}

}  // namespace vorotool::bindings
