// The largest and the smallest distances between sets of points, segments and polygons.
#include <cstdint>
#include <memory>
#include <tuple>
#include <vector>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/distances/closest.hpp"
#include "core/distances/farthest.hpp"
#include "core/distances/inside.hpp"
#include "core/distances/shape.hpp"

namespace vorotool::bindings {
namespace {

using core::base::Monitor;
using core::distances::Element;
using core::distances::Reached;
using core::distances::Shape;

using Pair = std::tuple<double, std::tuple<double, double>, std::tuple<double, double>>;

Pair pair_of(double distance, const core::kernel::Point& p, const core::kernel::Point& q) {
  return {distance, {p.x, p.y}, {q.x, q.y}};
}

// A shape that keeps the arrays it is of.
class KeptShape {
 public:
  // Elements are of x, y, x, y; rings of a polygon and whether it is a hole.
  KeptShape(const Places& elements, const Indices& ring_of, const IndexRows& rings, const Progress& progress)
      : kept_(keep(elements, ring_of, rings)),
        shape_(run_interruptible(progress, [&](const Monitor& monitor) {
          const auto own = rows<Element>(elements);
          const auto bounds = rows<Shape::Ring>(rings);
          if (own.size() != ring_of.size()) throw std::invalid_argument("each element must have one ring");
          core::base::check_range(view(ring_of), -1, bounds.size(), "a ring is out of range");
          return Shape(own, view(ring_of), bounds, monitor);
        })) {}

  const Shape& shape() const { return shape_; }

 private:
  std::shared_ptr<const void> kept_;
  Shape shape_;
};

Pair farthest_place(const KeptShape& from, const KeptShape& to, unsigned threads, const Progress& progress) {
  if (to.shape().empty()) throw std::invalid_argument("there is nothing to be far from");
  const auto found = run_interruptible(progress, core::distances::farthest_place, from.shape(), to.shape(),
                                       core::base::resolve_threads(threads));
  return pair_of(found.distance, found.from, found.on);
}

bool may_go_farther_inside(const KeptShape& of, const KeptShape& to, double least, const Progress& progress) {
  constexpr std::size_t most = 1 << 14;  // squares: some tens of milliseconds
  return run_interruptible(progress, core::distances::may_go_farther_inside, of.shape(), to.shape(), least,
                           most);
}

Pair closest_places(const KeptShape& a, const KeptShape& b, unsigned threads, const Progress& progress) {
  const auto found = run_interruptible(progress, core::distances::closest_places, a.shape(), b.shape(),
                                       core::base::resolve_threads(threads));
  return pair_of(found.distance, found.on_a, found.on_b);
}

auto contained(const KeptShape& kept, const Places& places, unsigned threads, const Progress& progress) {
  return to_numpy(run_interruptible(progress, core::distances::contained, kept.shape(),
                                    rows<core::kernel::Point>(places), core::base::resolve_threads(threads)));
}

auto reached(const KeptShape& kept, const Places& places, unsigned threads, const Progress& progress) {
  if (kept.shape().empty()) throw std::invalid_argument("there is nothing to be far from");
  const auto found =
      run_interruptible(progress, core::distances::reached, kept.shape(), rows<core::kernel::Point>(places),
                        core::base::resolve_threads(threads));
  std::vector<core::kernel::Point> on;
  on.reserve(found.size());
  for (const Reached& each : found) on.push_back(each.on);
  return std::make_tuple(column<double>(found, [](const Reached& each) { return each.distance; }),
                         two_columns(std::move(on)));
}

}  // namespace

void bind_distances(nb::module_& room) {
  nb::class_<KeptShape>(room, "Shape")
      .def(nb::init<const Places&, const Indices&, const IndexRows&, const Progress&>(), "elements"_a,
           "ring_of"_a, "rings"_a, "progress"_a.none())
      .def("contained", &contained, "places"_a, "threads"_a, "progress"_a.none(),
           "Of each place whether it is inside a polygon or on its outline.")
      .def("reached", &reached, "places"_a, "threads"_a, "progress"_a.none(),
           "Of each place the distance, and the nearest place of the shape.");
  room.def("farthest_place", &farthest_place, "of"_a, "to"_a, "threads"_a, "progress"_a.none(),
           "The largest distance, -1 if there is none, the place, and the nearest one of the other shape.");
  room.def("may_go_farther_inside", &may_go_farther_inside, "of"_a, "to"_a, "least"_a, "progress"_a.none(),
           "False if no place inside the polygons of the first shape is farther from the second.");
  room.def("closest_places", &closest_places, "a"_a, "b"_a, "threads"_a, "progress"_a.none(),
           "The smallest distance, -1 if there is none, and a place of each.");
}

}  // namespace vorotool::bindings
