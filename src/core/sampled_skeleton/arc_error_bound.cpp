#include "core/sampled_skeleton/arc_error_bound.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers/special_values.hpp"

namespace vorotool::core::sampled_skeleton {

using kernel::Point;
using numbers::infinity;

namespace {

// Lengths are below 2^32 lattice steps, and computed with a few roundings of 2^-53 each of them; seeds are
// within 2^-21 of their edges, and nodes within 2^-22 of where the seeds have them.
constexpr double relative_error = 0x1p-49, seed_error = 0x1p-20;

Point moved(const Point& p, double t, const Point& way) { return {p.x + t * way.x, p.y + t * way.y}; }
double between(const std::array<double, 2>& ends, double t) { return ends[0] + t * (ends[1] - ends[0]); }

// Of segments that do not cross.
double gap_between(const Point& a, const Point& b, const Point& c, const Point& d) {
  return std::min({closed_distance(a, c, d), closed_distance(b, c, d), closed_distance(c, a, b),
                   closed_distance(d, a, b)});
}

// The least |n - m| for a unit vector m that turns from one of two to the other by less than 180 degrees.
double least_difference(const Point& n, const Point& first, const Point& last) {
  const bool may_pass = cross(n, first) * cross(n, last) <= 0 && (dot(n, first) > 0 || dot(n, last) > 0);
  return may_pass ? 0 : std::min(norm(n - first), norm(n - last));
}

}  // namespace

double closed_distance(const Point& p, const Point& a, const Point& b) {
  const Point way = b - a;
  const double square = dot(way, way);
  const double t = square > 0 ? std::clamp(dot(p - a, way) / square, 0.0, 1.0) : 0;
  return norm(p - moved(a, t, way));
}

// Bounds for the nearest edge C over a stretch: values at both of its ends.
struct ArcErrorBound::Nearest {
  const Seen& edge;
  std::array<Point, 2> place;
  std::array<double, 2> distance;
  Point normal;  // from the edge to the arc
  Point first_foot, last_foot;
  double reach;  // e is proved up to this

  double least() const { return std::min(distance[0], distance[1]); }
  // max |q - g|^2 - d^2, which is convex along the arc.
  double excess(const Point& g) const {
    double most = 0;
    for (int i = 0; i < 2; ++i) {
      const double far = dot(place[i] - g, place[i] - g), d = distance[i];
      most = std::max(
          most, far - d * d + 4 * relative_error * far + 2 * d * edge.error + seed_error * std::sqrt(far));
    }
    return most;
  }
  double height(const Point& g) const { return dot(g - edge.a, normal) - edge.error; }
  // 1. of the header
  double by_growth(const Point& g) const {
    const double h = height(g);
    return h > 0 ? excess(g) / (2 * h) : infinity;
  }
};

double ArcErrorBound::operator()(const Point& source, const Point& target, std::span<const ArcSample> seeds,
                                 std::span<const NearEdge> near, double reach, const Clearing& clearing) {
  see(source, target, near);
  const Point way = target - source;
  double bound = 0;
  for (const Seen& c : seen_) {
    Stretch part{0, 1};
    if (c.length == 0 || !stretch_of(c, part)) continue;
    const std::array<double, 2> height{between(c.height, part.from), between(c.height, part.to)};
    if (height[0] * height[1] <= 0) return infinity;
    const double sign = height[0] > 0 ? 1 : -1;
    Nearest nearest{c,
                    {moved(source, part.from, way), moved(source, part.to, way)},
                    {std::abs(height[0]), std::abs(height[1])},
                    {-sign * c.way.y, sign * c.way.x},
                    moved(c.a, between(c.foot, part.from), c.way),
                    moved(c.a, between(c.foot, part.to), c.way),
                    0};
    const bool is_nearer =
        seeds.empty() || std::any_of(seeds.begin(), seeds.end(), [&](const ArcSample& seed) {
          return nearest.excess({seed.place.x, seed.place.y}) > 0;
        });
    if (!is_nearer) continue;
    const double first = between(c.foot, part.from), last = between(c.foot, part.to);
    nearest.reach = std::min({reach, nearest.least(), first, last, c.length - first, c.length - last});
    nearest.reach =
        std::min(nearest.reach, clearing(nearest.first_foot, nearest.last_foot, c.segment, reach));
    bound = std::max(bound, bound_by(nearest, part, seeds));
  }
  return bound;
}

ArcErrorBound::Clearing ArcErrorBound::clearing_among(std::span<const NearEdge> near) {
  return [near](const Point& first, const Point& last, std::int32_t segment, double reach) {
    double least = reach;
    for (const NearEdge& other : near) {
      if (other.segment == segment) continue;
      const Point a{static_cast<double>(other.site.a.x), static_cast<double>(other.site.a.y)};
      const Point b{static_cast<double>(other.site.b.x), static_cast<double>(other.site.b.y)};
      least = std::min(least, gap_between(first, last, a, b));
    }
    return least;
  };
}

void ArcErrorBound::see(const Point& source, const Point& target, std::span<const NearEdge> near) {
  seen_.clear();
  for (const NearEdge& edge : near) {
    const auto [a, b] = edge.site;
    const kernel::LatticeVector along = b - a;
    Seen seen{{static_cast<double>(a.x), static_cast<double>(a.y)},
              {static_cast<double>(along.x), static_cast<double>(along.y)},
              std::sqrt(static_cast<double>(kernel::norm2(along))),
              0,
              {},
              {},
              edge.segment};
    if (seen.length > 0) seen.way = {seen.way.x / seen.length, seen.way.y / seen.length};
    for (std::size_t i = 0; i < 2; ++i) {
      const Point from = (i == 0 ? source : target) - seen.a;
      seen.height[i] = cross(seen.way, from);
      seen.foot[i] = dot(seen.way, from);
      seen.error = std::max(seen.error, relative_error * (std::abs(from.x) + std::abs(from.y)) + seed_error);
    }
    seen_.push_back(seen);
  }
}

// Feet lie on the edge, and no other edge is nearer. Where that is not clear the stretch gets longer, not
// shorter.
bool ArcErrorBound::stretch_of(const Seen& c, Stretch& part) const {
  // keeps where a linear function, given at both ends of the arc, is not negative
  const auto clip = [&](double first, double last) {
    if (first < 0 && last < 0) return false;
    if (first < 0) part.from = std::max(part.from, first / (first - last));
    if (last < 0) part.to = std::min(part.to, first / (first - last));
    return part.from <= part.to;
  };
  if (!clip(c.foot[0] + c.error, c.foot[1] + c.error)) return false;
  if (!clip(c.length + c.error - c.foot[0], c.length + c.error - c.foot[1])) return false;
  for (const Seen& d : seen_) {
    if (&d == &c || d.length == 0) continue;
    const auto is_inside = [&](double t) {
      const double foot = between(d.foot, t);
      return foot >= d.error && foot <= d.length - d.error;
    };
    if (!is_inside(part.from) || !is_inside(part.to) || d.height[0] * d.height[1] <= 0) continue;
    const double error = c.error + d.error;
    if (!clip(std::abs(d.height[0]) - std::abs(c.height[0]) + error,
              std::abs(d.height[1]) - std::abs(c.height[1]) + error)) {
      return false;
    }
  }
  return true;
}

double ArcErrorBound::bound_by(const Nearest& c, const Stretch& part,
                               std::span<const ArcSample> seeds) const {
  double bound = infinity;
  for (const Seen& d : seen_) {
    if (&d != &c.edge && d.length > 0) bound = std::min(bound, bound_by_edge(c, d, part));
  }
  for (const ArcSample& seed : seeds) {
    const bool is_on = std::find(seed.labels.begin(), seed.labels.end(), c.edge.segment) != seed.labels.end();
    if (is_on || (seed.labels.size() == 1 && bound < infinity)) continue;  // its edge shows more
    bound = std::min(bound, bound_by_seed(c, {seed.place.x, seed.place.y}));
  }
  return bound;
}

double ArcErrorBound::bound_by_edge(const Nearest& c, const Seen& d, const Stretch& part) {
  const std::array<double, 2> height{between(d.height, part.from), between(d.height, part.to)};
  const std::array<double, 2> foot{between(d.foot, part.from), between(d.foot, part.to)};
  if (height[0] * height[1] <= 0) return infinity;
  const double sign = height[0] > 0 ? 1 : -1;
  const Point normal{-sign * d.way.y, sign * d.way.x};
  const double s = norm(c.normal - normal) - relative_error;
  if (!(s > 0)) return infinity;
  const double error = c.edge.error + d.error;
  std::array<double, 2> more{std::abs(height[0]) - c.distance[0], std::abs(height[1]) - c.distance[1]};
  const bool is_farther =
      std::min(more[0], more[1]) > -2 * error;  // its line might be nearer, if its feet are not
  for (double& distance : more) distance = std::max(distance, 0.0) + error;
  // whether, moved along a vector by so much of this, both ends have feet inside d, and so has what is
  // between
  const auto stays_inside = [&](const Point& way) {
    const double along = dot(way, d.way);
    for (std::size_t i = 0; i < 2; ++i) {
      const double after = foot[i] + along * more[i];
      if (after < d.error || after > d.length - d.error) return false;
    }
    return is_farther;
  };
  const double most = std::max(more[0], more[1]);
  const Point across{(c.normal.x - normal.x) / (s * s), (c.normal.y - normal.y) / (s * s)};
  if (most / s < c.reach && stays_inside(across)) return most / s;
  // until the disc that grows touches the line of d
  const Point grown{2 * c.normal.x / (s * s), 2 * c.normal.y / (s * s)};
  if (stays_inside(grown)) return 2 * most / (s * s);
  const double middle = std::clamp((foot[0] + foot[1]) / 2, 0.0, d.length);
  return std::min(
      {c.by_growth(moved(d.a, middle, d.way)), c.by_growth(d.a), c.by_growth(moved(d.a, d.length, d.way))});
}

double ArcErrorBound::bound_by_seed(const Nearest& c, const Point& g) {
  const double excess = c.excess(g), grown = c.by_growth(g);
  const Point first = c.place[0] - g, last = c.place[1] - g;
  const double first_length = norm(first), last_length = norm(last);
  const double s = least_difference(c.normal, {first.x / first_length, first.y / first_length},
                                    {last.x / last_length, last.y / last_length}) -
                   relative_error;
  if (!(s > 0)) return grown;
  const double half = s * (c.least() + std::max(c.least(), closed_distance(g, c.place[0], c.place[1]))) / 2;
  const double root = half * half - (1 - s * s / 4) * excess;
  if (root < 0) return grown;
  const double across = excess / (half + std::sqrt(root));
  return across < c.reach ? std::min(across, grown) : grown;
}

}  // namespace vorotool::core::sampled_skeleton
