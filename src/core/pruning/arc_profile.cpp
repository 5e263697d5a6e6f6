#include "core/pruning/arc_profile.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers/double_double.hpp"
#include "core/numbers/special_values.hpp"

namespace vorotool::core::pruning {

using kernel::Point;
using numbers::infinity;
using skeleton::ArcEnd;

namespace {

// (b - a) x (c - a). Of points on a lattice of 31 bits the products have 64: where they cancel to less than
// 2^-20, two doubles hold the difference to 2^-80 of itself or more.
double cross(const Point& a, const Point& b, const Point& c) {
  const Point ab = b - a, ac = c - a;
  const double plus = ab.x * ac.y, less = ab.y * ac.x;
  if (std::abs(plus - less) > 0x1p-20 * (std::abs(plus) + std::abs(less))) return plus - less;
  const auto difference = [](double p, double q) {
    return numbers::DoubleDouble(numbers::two_difference(p, q));
  };
  return (difference(b.x, a.x) * difference(c.y, a.y) - difference(b.y, a.y) * difference(c.x, a.x)).head;
}

// The closed site is a point there: of itself, or as the end of a segment that the foot lies at.
bool has_foot_at(const std::array<Point, 2>& site, const Point& place, const Point*& end) {
  const Point along = site[1] - site[0];
  const double t = dot(place - site[0], along);
  end = t <= 0 ? &site[0] : &site[1];
  return t <= 0 || t >= dot(along, along);
}

// On which side of the line of a segment the disc is that touches it, and the other segment near a place: the
// disc is where its other foot is.
double side_of_other_foot(const std::array<Point, 2>& line, const std::array<Point, 2>& other,
                          const Point& place) {
  const Point along = other[1] - other[0];
  const double s = std::clamp(dot(place - other[0], along) / dot(along, along), 0.0, 1.0);
  const double height = (1 - s) * cross(line[0], line[1], other[0]) + s * cross(line[0], line[1], other[1]);
  return height < 0 ? -1 : 1;
}

}  // namespace

ArcProfile::ArcProfile(const skeleton::SkeletonView& skeleton, std::size_t arc)
    : is_curved_(skeleton.is_curved(arc)),
      radius_{skeleton.source_radius(arc), skeleton.target_radius(arc)},
      length_(skeleton.length[arc]) {
  const ArcEnd source{skeleton.source(arc), radius_[0]}, target{skeleton.target(arc), radius_[1]};
  const Point middle{(source.place.x + target.place.x) / 2, (source.place.y + target.place.y) / 2};
  const auto& left = skeleton.site_ends[static_cast<std::size_t>(skeleton.sites[arc][0])];
  const auto& right = skeleton.site_ends[static_cast<std::size_t>(skeleton.sites[arc][1])];
  // what leads to a corner past the shortened edges is still between their lines
  const bool ends_count = skeleton.has_gap && radius_[0] > 0 && radius_[1] > 0;
  const Point *left_end = &left[0], *right_end = &right[0];
  const bool left_is_point = left[0] == left[1] || (ends_count && has_foot_at(left, middle, left_end));
  const bool right_is_point = right[0] == right[1] || (ends_count && has_foot_at(right, middle, right_end));
  if (left_is_point && right_is_point) {
    between_points(*left_end, *right_end, source, target);
  } else if (left_is_point) {
    from_focus(*left_end, right, source, target);
  } else if (right_is_point) {
    from_focus(*right_end, left, source, target);
  } else {
    between_lines(left, right, middle);
  }
}

// The ways from the center to both feet are across the lines; the tangent of half the angle between them is
// written so that nothing cancels.
void ArcProfile::between_lines(const std::array<Point, 2>& left, const std::array<Point, 2>& right,
                               const Point& middle) {
  kind = Kind::lines;
  const Point a = left[1] - left[0], b = right[1] - right[0];
  const double sides = side_of_other_foot(left, right, middle) * side_of_other_foot(right, left, middle);
  const double cosine = sides * dot(a, b), sine = std::abs(cross({0, 0}, a, b)), both = norm(a) * norm(b);
  size = cosine > 0 ? sine / (both + cosine) : sine > 0 ? (both - cosine) / sine : infinity;
}

void ArcProfile::between_points(const Point& left, const Point& right, const ArcEnd& source,
                                const ArcEnd& target) {
  kind = Kind::points;
  const Point across = right - left;
  const double distance = norm(across);
  const auto parameter = [&](const Point& p) {
    const Point middle{(left.x + right.x) / 2, (left.y + right.y) / 2};
    return kernel::cross(across, p - middle) / (distance * distance / 2);
  };
  size = distance / 2;
  from = parameter(source.place);
  to = parameter(target.place);
}

void ArcProfile::from_focus(const Point& focus, const std::array<Point, 2>& line, const ArcEnd& source,
                            const ArcEnd& target) {
  kind = Kind::parabola;
  Point along = line[1] - line[0];
  const double length = norm(along);
  double height = cross(line[0], line[1], focus) / length;
  if (height < 0) {
    along = {-along.x, -along.y};
    height = -height;
  }
  if (height == 0) {  // both feet are one: the center is above the end of a line
    kind = Kind::lines;
    size = 0;
    return;
  }
  const skeleton::Parabola parabola{focus, along.x / length, along.y / length, height};
  size = height;
  from = parabola.parameter(source) / height;
  to = parabola.parameter(target) / height;
}

ArcProfile::Course ArcProfile::angle() const {
  const double larger = source_is_larger() ? 0 : 1;
  if (kind == Kind::lines) return {size, size, size, larger};
  const double a = 1 / std::abs(from), b = 1 / std::abs(to);
  if ((from < 0 && to > 0) || (from > 0 && to < 0)) return {a, b, infinity, from / (from - to)};
  return {a, b, std::max(a, b), a == b ? larger : a > b ? 0.0 : 1.0};
}

ArcProfile::Course ArcProfile::chord() const {
  const double a = chord_at(from, radius_[0]), b = chord_at(to, radius_[1]);
  return {a, b, std::max(a, b), (a == b ? source_is_larger() : a > b) ? 0.0 : 1.0};
}

double ArcProfile::chord_at(double x, double radius) const {
  if (kind == Kind::points) return 2 * size;
  if (kind == Kind::parabola) return size * std::sqrt(1 + x * x);
  return size > 1e8 ? 2 * radius : 2 * radius * size / std::sqrt(1 + size * size);
}

double ArcProfile::angle_reached(double value, bool from_target) const {
  const double x = std::copysign(1 / value, from_target ? to : from);
  return std::clamp((x - from) / (to - from), 0.0, 1.0);
}

double ArcProfile::chord_reached(double value, bool from_target) const {
  if (kind == Kind::parabola) {
    const double relative = value / size;
    const double x = std::sqrt(std::max(0.0, (relative - 1) * (relative + 1)));
    return std::clamp(((from < to) == from_target ? -x - from : x - from) / (to - from), 0.0, 1.0);
  }
  const double a = chord_at(from, radius_[0]), b = chord_at(to, radius_[1]);
  return std::clamp((value - a) / (b - a), 0.0, 1.0);
}

double ArcProfile::radius(double u) const {
  if (u == 0 || u == 1) return radius_[u == 0 ? 0 : 1];
  if (is_curved_ && kind == Kind::parabola) return size * (1 + x(u) * x(u)) / 2;
  if (kind == Kind::points) return size * std::sqrt(1 + x(u) * x(u));
  return radius_[0] + u * (radius_[1] - radius_[0]);
}

double ArcProfile::length(double u0, double u1) const {
  if (u0 == 0 && u1 == 1) return length_;
  if (is_curved_ && kind == Kind::parabola) return skeleton::arc_length(size, size * x(u0), size * x(u1));
  return (u1 - u0) * length_;
}

// Bisection: the length grows with the parameter, and halves of a double's bits are its steps.
double ArcProfile::at_length(double distance) const {
  if (!(is_curved_ && kind == Kind::parabola)) {
    return length_ > 0 ? std::clamp(distance / length_, 0.0, 1.0) : 0;
  }
  double low = 0, high = 1;
  while (true) {
    const double middle = low + (high - low) / 2;
    if (!(low < middle && middle < high)) return middle;
    (length(0, middle) < distance ? low : high) = middle;
  }
}

}  // namespace vorotool::core::pruning
