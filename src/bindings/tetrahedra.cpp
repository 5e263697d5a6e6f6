// Delaunay triangulation of space and its check, and the exact predicates, each of their levels alone for the tests.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/base/indices.hpp"
#include "core/tetrahedra/delaunay_tetrahedra.hpp"
#include "core/tetrahedra/point3.hpp"
#include "core/tetrahedra/point_table.hpp"
#include "core/tetrahedra/predicates.hpp"
#include "core/tetrahedra/spheres.hpp"
#include "core/tetrahedra/tetrahedral_mesh.hpp"
#include "core/tetrahedra/verify_tetrahedra.hpp"

namespace vorotool::bindings {
namespace {

using core::tetrahedra::Point3;

template <std::size_t n>
using PointTuples = Aligned<const double, nb::shape<-1, n, 3>, nb::c_contig, nb::device::cpu>;

template <class Predicate>
struct Level {
  const char* name;
  Predicate predicate;
};

// sign(p) for the points p of each tuple, by the level of that name.
template <std::size_t n, class Predicate, std::size_t levels, class Call>
auto signs(const PointTuples<n>& tuples, const Level<Predicate> (&known)[levels], const std::string& name,
           Call call) {
  for (const Level<Predicate>& level : known) {
    if (level.name != name) continue;
    std::vector<std::int8_t> result(tuples.shape(0));
    {
      const nb::gil_scoped_release released;
      const Point3* p = reinterpret_cast<const Point3*>(tuples.data());
      for (std::int8_t& sign : result) sign = static_cast<std::int8_t>(call(level.predicate, p)), p += n;
    }
    return to_numpy(std::move(result));
  }
  throw std::invalid_argument("no level of the predicates is called '" + name + "'");
}

auto orient3d(const PointTuples<4>& points, const std::string& name) {
  using Predicate = int (*)(const Point3&, const Point3&, const Point3&, const Point3&);
  static constexpr Level<Predicate> levels[] = {{"auto", core::tetrahedra::orient3d},
                                                {"filter", core::tetrahedra::orient3d_filter},
                                                {"integers", core::tetrahedra::orient3d_integers},
                                                {"wide", core::tetrahedra::orient3d_wide}};
  return signs<4>(points, levels, name,
                  [](Predicate predicate, const Point3* p) { return predicate(p[0], p[1], p[2], p[3]); });
}

auto in_sphere(const PointTuples<5>& points, const std::string& name) {
  using Predicate = int (*)(const Point3&, const Point3&, const Point3&, const Point3&, const Point3&);
  static constexpr Level<Predicate> levels[] = {{"auto", core::tetrahedra::in_sphere},
                                                {"ties", core::tetrahedra::in_sphere_or_tie},
                                                {"filter", core::tetrahedra::in_sphere_filter},
                                                {"integers", core::tetrahedra::in_sphere_integers},
                                                {"wide", core::tetrahedra::in_sphere_wide}};
  return signs<5>(points, levels, name, [](Predicate predicate, const Point3* p) {
    return predicate(p[0], p[1], p[2], p[3], p[4]);
  });
}

// The predicates of a set, for the rows of four or five points of it: the sign of orient3d, or of in_sphere with ties
// broken.
auto set_signs(const Places& points, const IndexRows& tuples, bool on_integers) {
  const std::span<const Point3> given = rows<Point3>(points);
  std::vector<Point3> moved(given.begin(), given.end());
  if (on_integers) core::tetrahedra::move_to_integers(moved);
  const core::tetrahedra::SetPredicates predicates(moved);
  if (tuples.shape(1) != 4 && tuples.shape(1) != 5)
    throw std::invalid_argument("rows must have 4 or 5 points");
  core::base::check_range(view(tuples), 0, moved.size(), "an index is out of range");
  std::vector<std::int8_t> result(tuples.shape(0));
  for (std::size_t k = 0; k < result.size(); ++k) {
    const auto p = [&](std::size_t i) -> const Point3& {
      return moved[core::base::at(tuples.data()[tuples.shape(1) * k + i])];
    };
    result[k] =
        static_cast<std::int8_t>(tuples.shape(1) == 4 ? predicates.orient(p(0), p(1), p(2), p(3))
                                                      : predicates.in_sphere(p(0), p(1), p(2), p(3), p(4)));
  }
  return to_numpy(std::move(result));
}

// The values of rows of four, of which the first `count` are in use.
Array<std::int32_t> to_rows(core::base::LargeArray<std::array<std::int32_t, 4>>&& rows, std::size_t count) {
  using Rows = core::base::LargeArray<std::array<std::int32_t, 4>>;
  auto* data = rows.release();
  return {reinterpret_cast<std::int32_t*>(data), {count, 4}, nb::capsule(data, [](void* p) noexcept {
            Rows::free(static_cast<std::array<std::int32_t, 4>*>(p));
          })};
}

Columns triangulate(const Places& points, unsigned threads, const Progress& progress) {
  core::tetrahedra::Tetrahedra made =
      run_interruptible(progress, core::tetrahedra::triangulate, rows<Point3>(points), threads);
  Columns result;
  result["dimension"] = made.dimension;
  result["tetrahedra"] = to_rows(std::move(made.vertices), made.count);
  result["neighbors"] = to_rows(std::move(made.neighbors), made.count);
  result["first"] = to_numpy(std::move(made.first));
  result["duplicates"] = made.duplicates;
  return result;
}

using Row = std::array<std::int32_t, 4>;
using PointLabels = Vector<const std::int64_t>;

std::optional<std::string> find_fault(const Places& points, const IndexRows& tetrahedra,
                                      const IndexRows& neighbors, const Indices& first, unsigned threads,
                                      const Progress& progress) {
  const core::tetrahedra::TetrahedraView arrays{rows<Point3>(points), rows<Row>(tetrahedra),
                                                rows<Row>(neighbors), view(first)};
  return run_interruptible(progress, core::tetrahedra::find_fault, arrays, threads);
}

std::pair<Array<double>, Array<double>> spheres(const Places& points, const IndexRows& tetrahedra,
                                                unsigned threads, const Progress& progress) {
  core::base::check_range(view(tetrahedra), 0, points.shape(0),
                          "a tetrahedron names a point that does not exist");
  core::tetrahedra::Spheres made = run_interruptible(progress, core::tetrahedra::measure_spheres,
                                                     rows<Point3>(points), rows<Row>(tetrahedra), threads);
  const std::size_t count = tetrahedra.shape(0);
  Point3* ways = made.ways.release();
  return {
      {reinterpret_cast<double*>(ways),
       {count, 3},
       nb::capsule(ways,
                   [](void* p) noexcept { core::base::LargeArray<Point3>::free(static_cast<Point3*>(p)); })},
      to_numpy(std::move(made.volumes), {count})};
}

Columns point_table(const Places& points, const IndexRows& tetrahedra, const IndexRows& neighbors,
                    const PointLabels& labels, unsigned threads, const Progress& progress) {
  if (neighbors.shape(0) != tetrahedra.shape(0) || labels.size() != points.shape(0))
    throw std::invalid_argument("the arrays do not have the lengths of each other");
  core::tetrahedra::PointTable made =
      run_interruptible(progress, core::tetrahedra::point_table, rows<Point3>(points), rows<Row>(tetrahedra),
                        rows<Row>(neighbors), view(labels), threads);
  Columns result;
  result["neighbors"] = to_numpy(std::move(made.neighbors));
  result["cell_volume"] = to_numpy(std::move(made.cell_volume));
  result["nearest"] = to_numpy(std::move(made.nearest));
  result["on_hull"] = to_numpy(std::move(made.on_hull));
  return result;
}

Array<std::int32_t> nearest_corners(const Places& points, const IndexRows& simplices,
                                    const PointLabels& labels, unsigned threads, const Progress& progress) {
  if (labels.size() != points.shape(0)) throw std::invalid_argument("each point must have a label");
  const auto found = [&]<std::size_t corners>() {
    return to_numpy(
        run_interruptible(progress, core::tetrahedra::nearest_corners<corners>, rows<Point3>(points),
                          rows<std::array<std::int32_t, corners>>(simplices), view(labels), threads));
  };
  return simplices.shape(1) == 2 ? found.operator()<2>() : found.operator()<3>();
}

}  // namespace

void bind_tetrahedra(nb::module_& room) {
  static constexpr const char* levels =
      "A level is auto, filter, integers or wide; the sign is 2 where the filter cannot tell. The points "
      "must be "
      "finite.";
  nb::exception<core::tetrahedra::TooManyTetrahedra>(room, "TooManyTetrahedraError", PyExc_ValueError);
  room.def(
      "triangulate", &triangulate, "points"_a, "threads"_a, "progress"_a.none(),
      "dimension, that of the points, -1 of none: below 3 there are no tetrahedra; tetrahedra, positive, and "
      "the "
      "neighbors opposite to their vertices, -1 outside; first, for each point the first one at its place; "
      "duplicates, how many points have an earlier one.");
  room.def("find_fault", &find_fault, "points"_a, "tetrahedra"_a, "neighbors"_a, "first"_a, "threads"_a,
           "progress"_a.none());
  room.def(
      "spheres", &spheres, "points"_a, "tetrahedra"_a, "threads"_a, "progress"_a.none(),
      "The ways from the first corners of tetrahedra to the centers of their spheres, within 2^-43 of their "
      "lengths, and the volumes of the tetrahedra.");
  room.def("point_table", &point_table, "points"_a, "tetrahedra"_a, "neighbors"_a, "labels"_a, "threads"_a,
           "progress"_a.none(),
           "Of each point of a Delaunay triangulation: neighbors, how many; cell_volume within 2^-40 of "
           "itself, infinite "
           "on the hull; nearest, the nearest other point, of several that of the smallest label, or -1; "
           "on_hull.");
  room.def(
      "nearest_corners", &nearest_corners, "points"_a, "simplices"_a, "labels"_a, "threads"_a,
      "progress"_a.none(),
      "Of each point the nearest other corner of the edges or triangles that have it, as in point_table.");
  room.def("orient3d", &orient3d, "points"_a, "level"_a = "auto", levels);
  room.def("in_sphere", &in_sphere, "points"_a, "level"_a = "auto",
           "As orient3d; the level ties breaks ties as the triangulation does.");
  room.def("set_signs", &set_signs, "points"_a, "tuples"_a, "on_integers"_a,
           "Signs of orient3d of rows of four points of a set, or of in_sphere of five with ties broken, by "
           "the filters "
           "of the set; moved to integers first, if they can be.");
}

}  // namespace vorotool::bindings
