#include "core/offsets/level_arcs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/kernel/lattice.hpp"
#include "core/numbers/elementary.hpp"

namespace vorotool::core::offsets {

using kernel::Point;

namespace {

// From one direction to another, counter-clockwise and by at most half a turn.
double angle(const Point& a, const Point& b) {
  if (cross(a, b) > 0) return numbers::angle_of(dot(a, b), cross(a, b));
  return dot(a, b) < 0 ? std::numbers::pi : 0;
}

}  // namespace

LevelArcs::LevelArcs(const HalfEdges& borders, LevelCrossings& crossings, double level)
    : borders_(borders),
      diagram_(borders.diagram()),
      crossings_(crossings),
      level_(level),
      is_lone_(diagram_.points.size(), true) {
  for (const auto& ends : diagram_.segments) {
    for (const std::int32_t end : ends) is_lone_[static_cast<std::size_t>(end)] = false;
  }
}

bool LevelArcs::is_between_aligned(const PolygonFaces& domain, const Piece& piece) const {
  const auto& [first, last] = piece;
  if (!diagram_.is_point(site(piece)) || !domain.is_own_end(first) || !domain.is_own_end(last) ||
      borders_.left(first) == borders_.right(last)) {
    return false;
  }
  const kernel::LatticeSite one = diagram_.site(borders_.left(first)),
                            other = diagram_.site(borders_.right(last));
  return kernel::cross(one.b - one.a, other.b - other.a) == 0;
}

bool LevelArcs::is_lost(const Piece& piece) const {
  const std::int32_t about = site(piece);
  if (!diagram_.is_point(about)) return false;
  const Point a = crossings_.place(piece.first) - center_of(about),
              b = crossings_.place(piece.last) - center_of(about);
  return dot(a, b) > 0 && cross(a, b) <= 0 && !(is_lone(about) && turn(piece) > std::numbers::pi);
}

bool LevelArcs::is_long(const Piece& piece) const {
  return diagram_.is_point(site(piece)) && is_lone(site(piece)) && turn(piece) >= 3;
}

Point LevelArcs::middle(const Piece& piece) const {
  const Point center = center_of(site(piece));
  const Point a = crossings_.place(piece.first) - center, b = crossings_.place(piece.last) - center;
  const Point across = dot(a, b) > 0 ? Point{-a.x - b.x, -a.y - b.y} : Point{b.y - a.y, a.x - b.x};
  const double part = level_ / std::sqrt(dot(across, across));
  return {center.x + part * across.x, center.y + part * across.y};
}

std::vector<LevelArcs::Circle> LevelArcs::circles(const PolygonFaces& domain, const LevelSet& level) const {
  std::vector<Circle> found;
  if (std::find(is_lone_.begin(), is_lone_.end(), true) == is_lone_.end()) return found;
  std::vector<HalfEdge> border(is_lone_.size(), no_edge);
  std::vector<bool> is_free(is_lone_.begin(), is_lone_.end());
  for (HalfEdge h = 0; h < borders_.size(); ++h) {
    if (!diagram_.is_point(borders_.left(h))) continue;
    const auto point = static_cast<std::size_t>(borders_.left(h));
    border[point] = h;
    if (!level.is_edge_above(h)) is_free[point] = false;
  }
  for (std::size_t p = 0; p < is_free.size(); ++p) {
    if (!is_free[p]) continue;
    const HalfEdge h = border[p];
    if (h == no_edge ? !domain.is_outward : !domain.holds(borders_, h)) continue;
    found.push_back({static_cast<std::int32_t>(p), h});
  }
  return found;
}

Point LevelArcs::center_of(std::int32_t point) const {
  return {static_cast<double>(diagram_.point(point).x), static_cast<double>(diagram_.point(point).y)};
}

// How far the curve turns about a point of its own: as its cell does between both ends. Sums of rounded
// angles tell a small turn from a whole one.
double LevelArcs::turn(const Piece& piece) const {
  const auto [first, last] = piece;
  const Point center = center_of(site(piece));
  Point before = crossings_.place(first) - center;
  double sum = 0;
  const auto go_to = [&](const Point& direction) {
    sum += angle(before, direction);
    before = direction;
  };
  HalfEdge h = first ^ 1;
  do {
    const std::int32_t head = borders_.head(h);
    if (head < 0) go_to(borders_.way(h));
    h = borders_.next(h);
    const Point in = head < 0 ? borders_.way(h) : center - diagram_.vertices[static_cast<std::size_t>(head)];
    go_to({-in.x, -in.y});
  } while (h != last);
  go_to(crossings_.place(last) - center);
  return sum;
}

}  // namespace vorotool::core::offsets
