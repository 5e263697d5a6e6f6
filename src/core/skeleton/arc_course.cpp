#include "core/skeleton/arc_course.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numbers/elementary.hpp"

namespace vorotool::core::skeleton {
namespace {

using kernel::norm;
using kernel::Point;

constexpr int newton_steps = 64;  // it ends by itself, since the length is convex on each side of 0

double ratio(double a, double b) { return b != 0 ? a / b : 0; }

double spacing(double value) {
  return std::nextafter(value, std::numeric_limits<double>::infinity()) - value;
}

}  // namespace

double mean_root(double s, double t) {
  const double v = std::sqrt(1 + s * s), w = std::sqrt(1 + t * t);
  const double products = (v + w) / 2 + (s + t) * (s + t) / (2 * (v + w));
  const double same = s * t;
  const double outer = same > 0 ? (1 + s * s + t * t) / (v * w + std::abs(same)) : v * w - same;
  const double factor = (1 + outer) / (v + w);
  const double x = std::abs(t - s) * factor;
  return (products + factor * (x > 0 ? numbers::inverse_sinh(x) / x : 1.0)) / 2;
}

ArcCourse::ArcCourse(const SkeletonView& skeleton, std::size_t arc)
    : source_(skeleton.source(arc)),
      target_(skeleton.target(arc)),
      control_(skeleton.control[arc]),
      r0_(skeleton.source_radius(arc)),
      r1_(skeleton.target_radius(arc)),
      length_(skeleton.length[arc]),
      is_parabola_(skeleton.is_curved(arc)) {
  const auto& left = skeleton.site_ends[static_cast<std::size_t>(skeleton.sites[arc][0])];
  const auto& right = skeleton.site_ends[static_cast<std::size_t>(skeleton.sites[arc][1])];
  is_parting_ = !is_parabola_ && left[0] == left[1] && right[0] == right[1];
  if (is_parabola_) {
    const double growth = r1_ - r0_, chord = norm(target_ - source_);
    along_ = std::sqrt(std::max(chord - std::abs(growth), 0.0) * (chord + std::abs(growth)));
    const double height =
        norm(Point{source_.x - 2 * control_.x + target_.x, source_.y - 2 * control_.y + target_.y});
    const double middle = ratio(growth, along_), half_way = ratio(height, along_);
    slope0_ = middle - half_way;
    slope1_ = middle + half_way;
  } else if (is_parting_) {
    const Point across = left[0] - right[0];
    const Point between{(left[0].x + right[0].x) / 2, (left[0].y + right[0].y) / 2};
    half_ = norm(across) / 2;
    const auto slope_at = [&](const Point& end) {
      const Point from = end - between;
      return ratio(kernel::dot(from, {across.y, -across.x}), 2 * half_ * half_);
    };
    slope0_ = slope_at(source_);
    slope1_ = slope_at(target_);
  }
}

Point ArcCourse::place(double u) const {
  if (u >= 1) return target_;
  if (!is_parabola_) {
    return {source_.x + u * (target_.x - source_.x), source_.y + u * (target_.y - source_.y)};
  }
  const auto bent = [u](double source, double control, double target) {
    return source + u * (2 * (control - source) + u * (source - 2 * control + target));
  };
  return {bent(source_.x, control_.x, target_.x), bent(source_.y, control_.y, target_.y)};
}

double ArcCourse::radius(double u) const {
  if (u <= 0) return r0_;
  if (u >= 1) return r1_;
  const double here = slope(u);
  if (is_parabola_) return r0_ + along_ * u * (slope0_ + here) / 2;
  return is_parting_ ? half_ * std::sqrt(1 + here * here) : r0_ + u * (r1_ - r0_);
}

// The length to u is d times the integral of sqrt(1 + slope^2) over u. Newton's method from the nearer end of
// the bracket; a step that leaves the bracket halves it.
double ArcCourse::at_length(double distance) const {
  double u = std::clamp(ratio(distance, length_), 0.0, 1.0);
  if (!is_parabola_ || !(u > 0 && u < 1)) return u;
  double low = 0, high = 1;
  for (int k = 0; k < newton_steps; ++k) {
    const double here = slope(u);
    const double excess = along_ * u * mean_root(slope0_, here) - distance;
    if (excess < 0) low = u;
    if (excess > 0) high = u;
    const double newton = u - ratio(excess, along_ * std::sqrt(1 + here * here));
    const double better = newton > low && newton < high ? newton : (low + high) / 2;
    if (excess == 0 || !(std::abs(better - u) > spacing(u))) break;
    u = better;
  }
  return u;
}

}  // namespace vorotool::core::skeleton
