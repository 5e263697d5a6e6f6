#include "core/voronoi/border_curves.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"

namespace vorotool::core::voronoi {

using base::at;
using kernel::Point;

namespace {

constexpr std::size_t curves_a_piece = 1 << 15;  // borders a piece
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// About a focus, by t along the directrix from below the focus, which is on the left of its way: the distance
// from both is (t^2 + h^2) / (2 h), with h that of the focus from the directrix.
struct Parabola {
  Point focus, way;
  double height;

  // Of a place; on the steep sides of a sharp parabola the radius tells more than the place.
  double parameter(const Point& place, double radius) const {
    const double t = way.x * (place.x - focus.x) + way.y * (place.y - focus.y);
    if (height * radius < std::fabs(t) * (std::fabs(place.x) + std::fabs(place.y))) {
      return std::copysign(std::sqrt(std::max(height * (2 * radius - height), 0.0)), t);
    }
    return t;
  }

  Point control(const Point& source, const Point& target, double step) const {
    const double below = step * step / (4 * height);
    return {(source.x + target.x) / 2 + below * way.y, (source.y + target.y) / 2 + below * -way.x};
  }
};

// Between a point and a segment; no parabola, and the height 0, if the point is on its line.
Parabola parabola_of(const kernel::PlanarGraphView& graph, std::int32_t point, std::int32_t segment) {
  const kernel::LatticePoint &focus = graph.point(point), &a = graph.point(graph.ends(segment)[0]);
  kernel::LatticeVector along = graph.point(graph.ends(segment)[1]) - a;
  const std::int64_t height = cross(along, focus - a);
  if (height < 0) along = -along;
  const auto x = static_cast<double>(along.x), y = static_cast<double>(along.y);
  const double length = std::sqrt(x * x + y * y);
  return {{static_cast<double>(focus.x), static_cast<double>(focus.y)},
          {x / length, y / length},
          static_cast<double>(height < 0 ? -height : height) / length};
}

}  // namespace

base::LargeArray<double> control_points(const kernel::PlanarGraphView& graph,
                                        std::span<const std::int64_t> ends,
                                        std::span<const std::int64_t> elements, std::span<const Point> places,
                                        std::span<const double> radius, unsigned threads,
                                        const base::Monitor& monitor) {
  base::LargeArray<double> made(ends.size());
  base::for_items(ends.size() / 2, curves_a_piece, threads, monitor, [&](std::size_t b) {
    made[2 * b] = made[2 * b + 1] = not_a_number;
    const auto one = static_cast<std::int32_t>(elements[2 * b]),
               other = static_cast<std::int32_t>(elements[2 * b + 1]);
    if (graph.is_point(one) == graph.is_point(other)) return;
    const Parabola parabola = parabola_of(graph, std::min(one, other), std::max(one, other));
    if (parabola.height == 0) return;
    const auto source = static_cast<std::size_t>(ends[2 * b]),
               target = static_cast<std::size_t>(ends[2 * b + 1]);
    const double first = parabola.parameter(places[source], radius[source]);
    const double last = parabola.parameter(places[target], radius[target]);
    const Point control = parabola.control(places[source], places[target], last - first);
    made[2 * b] = control.x;
    made[2 * b + 1] = control.y;
  });
  return made;
}

}  // namespace vorotool::core::voronoi
