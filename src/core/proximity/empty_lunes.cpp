#include "core/proximity/empty_lunes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/indices.hpp"
#include "core/delaunay/half_edge.hpp"
#include "core/kernel/circumcenter.hpp"

namespace vorotool::core::proximity {

using base::at;
using delaunay::following;
using delaunay::preceding;
using kernel::Point;

namespace {

// Of a vector and of distances of about 2^-400 or less nothing is said: they count as near.
constexpr double out_of_range = 0x1p-900;
constexpr double more = 1 + 0x1p-30;

// Whether a segment is certainly farther from a place than the root of `reach`. It gives the ends as seen
// from the place. Their differences are right to u, the cross product to 4 u of its products, and a dot
// product that is taken for positive wrongly makes the nearest place of the segment nearer than its end by
// less than 64 u^2 of the distance: `more` is more than all of that.
bool is_beyond(const Point& a, const Point& b, double reach) {
  const Point way{b.x - a.x, b.y - a.y};
  const double left = a.x * way.y, right = a.y * way.x;
  const double height = std::abs(left - right) - 0x1p-48 * (std::abs(left) + std::abs(right));
  if (height > 0 && height * height > more * reach * dot(way, way) + out_of_range) return true;
  const double bound = more * reach + out_of_range;
  return (dot(a, way) > 0 && dot(a, a) > bound) || (dot(b, way) < 0 && dot(b, b) > bound);
}

}  // namespace

struct EmptyLunes::Lune {
  Point a, b;
  double reach;  // about the square of the distance between both, scaled

  bool holds(const Point& p) const {
    return kernel::compare_distances(a, p, b) < 0 && kernel::compare_distances(b, p, a) < 0;
  }
};

double scale_of(std::span<const Point> points) {
  double largest = 0;
  for (const Point& p : points) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
  if (largest == 0) return 1;
  return std::ldexp(1.0, -std::clamp(std::ilogb(largest), -1000, 1000));
}

bool EmptyLunes::is_empty(std::int32_t side) {
  const auto h = static_cast<std::size_t>(side);
  const auto corner = [&](std::size_t i) { return at(mesh_.triangles[i]); };
  const Point &a = mesh_.points[corner(following(h))], &b = mesh_.points[corner(preceding(h))];
  const Point way{(b.x - a.x) * scale_, (b.y - a.y) * scale_};
  const Lune lune{a, b, dot(way, way)};
  if (lune.holds(mesh_.points[corner(h)])) return false;
  triangles_.assign(1, side / 3);
  sides_.clear();
  for (const std::size_t next : {following(h), preceding(h)}) {
    if (may_meet(lune, next)) sides_.push_back(next);
  }
  sides_.push_back(h);  // the other triangle of the edge comes first
  while (!sides_.empty()) {
    const std::size_t next = sides_.back();
    sides_.pop_back();
    if (finds_inside(lune, next)) return false;
  }
  return true;
}

bool EmptyLunes::finds_inside(const Lune& lune, std::size_t side) {
  const std::int32_t t = mesh_.neighbors[side];
  if (t < 0 || std::find(triangles_.begin(), triangles_.end(), t) != triangles_.end()) return false;
  triangles_.push_back(t);
  const std::int32_t from = mesh_.triangles[following(side)], to = mesh_.triangles[preceding(side)];
  for (std::size_t k = 3 * at(t); k < 3 * at(t) + 3; ++k) {
    const std::int32_t apex = mesh_.triangles[k];
    if (apex == from || apex == to) {
      if (may_meet(lune, k)) sides_.push_back(k);
    } else if (lune.holds(mesh_.points[at(apex)])) {
      return true;
    }
  }
  return false;
}

bool EmptyLunes::may_meet(const Lune& lune, std::size_t side) const {
  const Point& u = mesh_.points[at(mesh_.triangles[following(side)])];
  const Point& w = mesh_.points[at(mesh_.triangles[preceding(side)])];
  const auto seen = [&](const Point& p, const Point& c) {
    return Point{(p.x - c.x) * scale_, (p.y - c.y) * scale_};
  };
  return !is_beyond(seen(u, lune.a), seen(w, lune.a), lune.reach) &&
         !is_beyond(seen(u, lune.b), seen(w, lune.b), lune.reach);
}

}  // namespace vorotool::core::proximity
