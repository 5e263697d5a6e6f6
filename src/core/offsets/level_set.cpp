#include "core/offsets/level_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/kernel/lattice.hpp"

namespace vorotool::core::offsets {

using kernel::LatticeSite;
using kernel::Point;

namespace {

constexpr double none = std::numeric_limits<double>::infinity();

Point from(const kernel::LatticePoint& p, const Point& way, double distance) {
  const double part = distance / norm(way);
  return {p.x + part * way.x, p.y + part * way.y};
}

Point middle_of(const LatticeSite& left, const LatticeSite& right) {
  return {(static_cast<double>(left.a.x) + right.a.x) / 2, (static_cast<double>(left.a.y) + right.a.y) / 2};
}

}  // namespace

double LevelSet::minimum(HalfEdge h) const {
  const segment_voronoi::build::DiagramView& diagram = borders_.diagram();
  const LatticeSite left = diagram.site(borders_.left(h)), right = diagram.site(borders_.right(h));
  if (left.is_point() && right.is_point()) return minimum_between_points(h, left, right);
  // the end itself is on the edge
  if (is_end_of(left, right) || is_end_of(right, left)) return 0;
  const skeleton::BisectorArc arc(left, right);
  if (!arc.is_parabola) return none;
  const double t0 = arc.parabola.parameter(end(borders_.tail(h)));
  const double t1 = arc.parabola.parameter(end(borders_.head(h)));
  return (t0 < 0 && t1 > 0) || (t0 > 0 && t1 < 0) ? arc.parabola.h / 2 : none;
}

double LevelSet::minimum_between_points(HalfEdge h, const LatticeSite& left, const LatticeSite& right) const {
  const Point way = borders_.way(h);
  const Point middle = middle_of(left, right);
  const auto along = [&](std::int32_t vertex) {
    const Point place = end(vertex).place;
    return dot(place - middle, way);
  };
  const std::int32_t tail = borders_.tail(h), head = borders_.head(h);
  return (tail < 0 || along(tail) < 0) && (head < 0 || along(head) > 0) ? norm(way) / 4 : none;
}

Point LevelSet::crossing(HalfEdge h) const {
  if (ends_at_head(h)) return end(borders_.head(h)).place;  // all that end there meet
  const segment_voronoi::build::DiagramView& diagram = borders_.diagram();
  const LatticeSite left = diagram.site(borders_.left(h)), right = diagram.site(borders_.right(h));
  if (left.is_point() && right.is_point()) return crossing_between_points(h, left, right);
  if (is_end_of(left, right) || is_end_of(right, left)) return beside_end(left, right);
  const skeleton::BisectorArc arc(left, right);
  if (!arc.is_parabola) return crossing_between_segments(h);
  // the focus is to the left of growing parameters; towards the minimum, which is at 0
  const double h0 = arc.parabola.h, t = std::sqrt(h0) * std::sqrt(std::max(0.0, 2 * level_ - h0));
  const double sign = left.is_point() ? 1 : -1;
  if (is_beyond_head(h, -t, [&](const skeleton::ArcEnd& end) { return sign * arc.parabola.parameter(end); }))
    return end(borders_.head(h)).place;
  return arc.parabola.place(-sign * t);
}

// Where the clearance hardly changes, rounding may put a crossing beyond the end that it comes before. Parameters
// grow along the half-edge.
template <class Parameter>
bool LevelSet::is_beyond_head(HalfEdge h, double crossing, const Parameter& parameter) const {
  return !is_above(borders_.head(h)) && crossing >= parameter(end(borders_.head(h)));
}

// Towards the middle of the points.
Point LevelSet::crossing_between_points(HalfEdge h, const LatticeSite& left, const LatticeSite& right) const {
  const Point way = borders_.way(h);
  const double length = norm(way), half = length / 4;
  const double back = std::sqrt(std::max(0.0, level_ - half)) * std::sqrt(level_ + half) / length;
  const Point middle = middle_of(left, right);
  if (is_beyond_head(h, -back, [&](const skeleton::ArcEnd& end) {
        return dot(end.place - middle, way) / (length * length);
      }))
    return end(borders_.head(h)).place;
  return {middle.x - back * way.x, middle.y - back * way.y};
}

// The clearance grows evenly; from the nearer end, since the other one may be far away.
Point LevelSet::crossing_between_segments(HalfEdge h) const {
  const skeleton::ArcEnd low = end(borders_.head(h)), high = end(borders_.tail(h));
  const double part = (level_ - low.radius) / (high.radius - low.radius);
  return {low.place.x + part * (high.place.x - low.place.x),
          low.place.y + part * (high.place.y - low.place.y)};
}

Point LevelSet::beside_end(const LatticeSite& left, const LatticeSite& right) const {
  const kernel::LatticePoint& end = left.is_point() ? left.a : right.a;
  const LatticeSite& segment = left.is_point() ? right : left;
  const kernel::LatticeVector across = kernel::left_of(segment.b - segment.a);
  const Point normal{static_cast<double>(across.x), static_cast<double>(across.y)};
  return from(end, normal, begins_left(left, right) ? level_ : -level_);
}

}  // namespace vorotool::core::offsets
