// Planar graphs, and the exact predicates, each of their levels alone for the tests.
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/planar_graph.hpp"
#include "core/kernel/predicates.hpp"

namespace vorotool::bindings {
namespace {

using core::kernel::Point;

template <std::size_t n>
using PointTuples = Aligned<const double, nb::shape<-1, n, 2>, nb::c_contig, nb::device::cpu>;

template <class Predicate>
struct Level {
  const char* name;
  Predicate predicate;
};

template <class Predicate, std::size_t n>
Predicate find_level(const Level<Predicate> (&levels)[n], const std::string& name) {
  for (const Level<Predicate>& level : levels) {
    if (level.name == name) return level.predicate;
  }
  throw std::invalid_argument("no level of the predicates is called '" + name + "'");
}

// sign(p) for the first of each tuple's points.
template <std::size_t n, class Sign>
auto signs(const PointTuples<n>& tuples, Sign sign) {
  std::vector<std::int8_t> result(tuples.shape(0));
  {
    const nb::gil_scoped_release released;
    std::vector<Point> p(n);
    for (std::size_t k = 0; k < result.size(); ++k) {
      const double* values = tuples.data() + 2 * n * k;
      for (std::size_t i = 0; i < n; ++i) p[i] = {values[2 * i], values[2 * i + 1]};
      result[k] = static_cast<std::int8_t>(sign(p));
    }
  }
  return to_numpy(std::move(result));
}

// The filter of orient2d that the triangulation uses.
int seen_side(const Point& a, const Point& b, const Point& c) {
  return core::kernel::side_filter(core::kernel::seen_from(a, b, c));
}

auto orient2d(PointTuples<3> points, const std::string& name) {
  using Predicate = int (*)(const Point&, const Point&, const Point&);
  static constexpr Level<Predicate> levels[] = {{"auto", core::kernel::orient2d},
                                                {"filter", core::kernel::orient2d_filter},
                                                {"seen", seen_side},
                                                {"integers", core::kernel::orient2d_integers},
                                                {"expansions", core::kernel::orient2d_expansions},
                                                {"wide", core::kernel::orient2d_wide}};
  const Predicate predicate = find_level(levels, name);
  return signs<3>(points, [&](const std::vector<Point>& p) { return predicate(p[0], p[1], p[2]); });
}

auto incircle(PointTuples<4> points, const std::string& name) {
  using Predicate = int (*)(const Point&, const Point&, const Point&, const Point&);
  static constexpr Level<Predicate> levels[] = {{"auto", core::kernel::incircle},
                                                {"filter", core::kernel::incircle_filter},
                                                {"seen", core::kernel::incircle_filter},
                                                {"integers", core::kernel::incircle_integers},
                                                {"expansions", core::kernel::incircle_expansions},
                                                {"wide", core::kernel::incircle_wide}};
  const Predicate predicate = find_level(levels, name);
  return signs<4>(points, [&](const std::vector<Point>& p) { return predicate(p[0], p[1], p[2], p[3]); });
}

}  // namespace

void bind_kernel(nb::module_& room) {
  static constexpr const char* levels =
      "A level is auto, filter, seen (the filter of the triangulation), integers, expansions or wide; the "
      "sign is "
      "2 where a level other than auto and wide cannot tell. The points must be finite.";
  nb::class_<PlanarGraph>(room, "PlanarGraph")
      .def(nb::init<const IndexRows&, const IndexRows&, const IndexRows&>(), "points"_a, "segments"_a,
           "segment_faces"_a);
  room.def("orient2d", &orient2d, "points"_a, "level"_a = "auto", levels);
  room.def("incircle", &incircle, "points"_a, "level"_a = "auto", levels);
}

}  // namespace vorotool::bindings
