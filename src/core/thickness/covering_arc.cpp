#include "core/thickness/covering_arc.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers/special_values.hpp"

namespace vorotool::core::thickness {

using kernel::Point;
using numbers::infinity;
using skeleton::ArcEnd;

namespace {

constexpr Interval nothing{infinity, -infinity};

bool is_point(const std::array<Point, 2>& site) { return site[0] == site[1]; }

Point foot(const std::array<Point, 2>& site, const Point& place) {
  if (is_point(site)) return site[0];
  const Point along = site[1] - site[0];
  const double t = dot(place - site[0], along) / dot(along, along);
  return {site[0].x + t * along.x, site[0].y + t * along.y};
}

void include(Interval& interval, double value) {
  interval.first = std::min(interval.first, value);
  interval.last = std::max(interval.last, value);
}

Point direction(const Point& way) {
  const double length = norm(way);
  return {way.x / length, way.y / length};
}

double squared(double value) { return value * value; }

}  // namespace

Crescent::Crescent(const ArcEnd& upper, const ArcEnd& lower, const std::array<std::array<Point, 2>, 2>& feet,
                   double margin)
    : quadrilateral_{feet[1][0], feet[0][0], feet[0][1], feet[1][1]},
      center_(lower.place),
      radius_(lower.radius),
      margin_(margin),
      rows_(nothing) {
  const Point &a = feet[1][0], &b = feet[1][1];
  const Point chord = b - a;
  const Point moved{(a.x - feet[0][0].x) + (b.x - feet[0][1].x), (a.y - feet[0][0].y) + (b.y - feet[0][1].y)};
  const Point down = lower.place - upper.place;
  // Of a parabola the way of the foot on the line tells which side is outwards: the center may go around the
  // focus. Between two points no foot moves.
  const Point& way = moved == Point{0, 0} ? down : moved;
  const double length = norm(chord);
  if (length > 0) {
    outwards_ = direction({-chord.y, chord.x});
    if (dot(outwards_, way) < 0) outwards_ = {-outwards_.x, -outwards_.y};
  } else {
    outwards_ = {0, 0};  // the whole disc, which is a point
  }
  chord_ = length > 0 ? std::min(dot(a, outwards_), dot(b, outwards_)) - margin : -infinity;
  for (const Point& corner : quadrilateral_) include(rows_, corner.y);
  for (const double side : {-radius_, radius_}) {
    if (is_beyond({center_.x, center_.y + side})) include(rows_, center_.y + side);
  }
  rows_ = {rows_.first - margin, rows_.last + margin};
}

Interval Crescent::columns(double y) const {
  Interval found = nothing;
  for (std::size_t i = 0; i < 4; ++i) {
    const Point &p = quadrilateral_[i], &q = quadrilateral_[(i + 1) % 4];
    const double low = std::min(p.y, q.y), high = std::max(p.y, q.y);
    if (y < low - margin_ || y > high + margin_) continue;
    if (high - low <= margin_) {  // nearly level: all of it
      include(found, p.x);
      include(found, q.x);
    } else {
      const double part = (std::clamp(y, low, high) - p.y) / (q.y - p.y);
      include(found, p.x + part * (q.x - p.x));
    }
  }
  const double half = squared(radius_ + margin_) - squared(y - center_.y);
  if (half >= 0) {
    Interval disc{center_.x - std::sqrt(half), center_.x + std::sqrt(half)};
    const double rest = chord_ - y * outwards_.y;
    if (outwards_.x > 0) disc.first = std::max(disc.first, rest / outwards_.x);
    if (outwards_.x < 0) disc.last = std::min(disc.last, rest / outwards_.x);
    if (disc.first <= disc.last && (outwards_.x != 0 || rest <= 0)) {
      include(found, disc.first);
      include(found, disc.last);
    }
  }
  return {found.first - margin_, found.last + margin_};
}

CoveringArc::CoveringArc(const skeleton::SkeletonView& skeleton, std::size_t arc, double slack)
    : slack_(slack) {
  const base::IndexPair nodes = skeleton.arcs[arc];
  const ArcEnd source{skeleton.source(arc), skeleton.source_radius(arc)};
  const ArcEnd target{skeleton.target(arc), skeleton.target_radius(arc)};
  const bool falls = is_upper(skeleton, nodes[0], nodes[1]);
  upper_ = falls ? source : target;
  lower_ = falls ? target : source;
  sites_ = {skeleton.site_ends[static_cast<std::size_t>(skeleton.sites[arc][0])],
            skeleton.site_ends[static_cast<std::size_t>(skeleton.sites[arc][1])]};
  const pruning::ArcProfile profile(skeleton, arc);
  kind_ = profile.kind;
  size_ = profile.size;
  from_ = std::min(profile.from, profile.to);
  to_ = std::max(profile.from, profile.to);
  if (kind_ == Kind::parabola) set_parabola();
  if (kind_ == Kind::lines) set_lines();
}

void CoveringArc::set_parabola() {
  if (!is_point(sites_[0])) std::swap(sites_[0], sites_[1]);
  along_ = direction(sites_[1][1] - sites_[1][0]);
  if (cross(along_, sites_[0][0] - sites_[1][0]) < 0) along_ = {-along_.x, -along_.y};
}

// The tangent of half the angle between the ways to both feet is infinite between parallel lines.
void CoveringArc::set_lines() {
  along_ = upper_.place - lower_.place;
  from_ = 0, to_ = norm(along_);
  along_ = to_ > 0 ? direction(along_) : Point{0, 0};
  growth_ = 1 / std::sqrt(1 + size_ * size_);
  width_ = 1 / (1 + 1 / (size_ * size_));
  for (std::size_t i = 0; i < 2; ++i) {
    const Point along = direction(sites_[i][1] - sites_[i][0]);
    inwards_[i] = {-along.y, along.x};
    if (dot(inwards_[i], upper_.place - sites_[i][0]) < 0) inwards_[i] = {along.y, -along.x};
  }
}

Crescent CoveringArc::crescent(double margin) const {
  const auto feet = [&](const ArcEnd& end) {
    return std::array<Point, 2>{foot(sites_[0], end.place), foot(sites_[1], end.place)};
  };
  return {upper_, lower_, {feet(upper_), feet(lower_)}, margin};
}

bool CoveringArc::lower_covers(const Point& place) const {
  const Point way = place - lower_.place;
  return dot(way, way) <= squared(lower_.radius + slack_);
}

double CoveringArc::radius_over(const Point& place) const {
  double found = -1;
  if (kind_ == Kind::points) found = between_points(place);
  if (kind_ == Kind::parabola) found = on_parabola(place);
  if (kind_ == Kind::lines) found = between_lines(place);
  // discs grow towards both ends, so that a place between them which just covers may be less than the end
  return found < lower_.radius && lower_covers(place) ? lower_.radius : found;
}

// The disc through both points and the place: its center is at x = cot of the angle under which the place
// sees the points. Where coordinates are small integers, or half of these, no product is rounded.
double CoveringArc::between_points(const Point& place) const {
  const Point &left = sites_[0][0], &right = sites_[1][0];
  const Point p = place - left, q = place - right;
  const double x = dot(p, q) / cross(right - left, p);
  if (!(from_ <= x && x <= to_)) return -1;
  return size_ * std::sqrt(1 + x * x);
}

double CoveringArc::on_parabola_at(double x) const {
  return from_ <= x && x <= to_ ? size_ * (1 + x * x) / 2 : -1;
}

// The discs through the focus and the place that touch the line. In units of h, with the focus in the origin
// and the place at (u, v), its distance from the line is 1 + v; a center at x has the place on its disc where
// v x^2 + 2 u x - (v + u^2 + v^2) = 0. A quarter of the discriminant is (u^2 + v^2) (1 + v).
double CoveringArc::on_parabola(const Point& place) const {
  const Point way = place - sites_[0][0];
  const double u = dot(along_, way) / size_, v = cross(along_, way) / size_;
  const double above = cross(along_, place - sites_[1][0]) / size_;
  if (above < 0) return -1;
  const double distance2 = u * u + v * v;
  const double root = std::sqrt(distance2 * above);
  const double sum = u < 0 ? u - root : u + root;  // nothing cancels
  if (sum == 0) return -1;
  return std::max(on_parabola_at(-sum / v), on_parabola_at((v + distance2) / sum));
}

// Let k be how fast the radius r grows along the arc. At a place whose distances from both lines are a and b
// the larger of the two discs that touch it is where r = ((a + b) / 2 + k sqrt(a b)) / (1 - k^2): the distances
// are far from 0 where the place is, so that no difference of squares is needed.
double CoveringArc::between_lines(const Point& place) const {
  double apart[2];
  for (std::size_t i = 0; i < 2; ++i) {
    apart[i] = dot(inwards_[i], place - sites_[i][0]);
    if (apart[i] < 0) return -1;
  }
  const double mean = std::sqrt(apart[0] * apart[1]);
  const double t = (dot(along_, place - lower_.place) + growth_ * lower_.radius + mean) / width_;
  if (!(0 <= t && t <= to_)) return -1;
  return std::clamp(((apart[0] + apart[1]) / 2 + growth_ * mean) / width_, lower_.radius, upper_.radius);
}

}  // namespace vorotool::core::thickness
