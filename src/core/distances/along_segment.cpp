#include "core/distances/along_segment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/kernel/predicates.hpp"

namespace vorotool::core::distances {

using kernel::Point;

void add_meetings(const Element& segment, const Element& element, std::vector<double>& shares) {
  const int a = kernel::orient2d(segment.a, segment.b, element.a);
  const int b = kernel::orient2d(segment.a, segment.b, element.b);
  if (a * b > 0) return;
  const int c = kernel::orient2d(element.a, element.b, segment.a);
  const int d = kernel::orient2d(element.a, element.b, segment.b);
  if (c * d > 0) return;
  const Point u = segment.b - segment.a, v = element.b - element.a;
  const double slope = kernel::cross(u, v);
  if ((a == 0 && b == 0) || slope == 0) {
    shares.push_back(nearest_share(segment, element.a));
    shares.push_back(nearest_share(segment, element.b));
  } else {
    shares.push_back(std::clamp(kernel::cross(element.a - segment.a, v) / slope, 0.0, 1.0));
  }
}

bool is_covered(const Element& segment, std::span<const Element> elements) {
  const auto& [a, b] = segment;
  const bool by_x = std::abs(b.x - a.x) >= std::abs(b.y - a.y);
  const auto along = [by_x](const Element& e) {
    return by_x ? std::minmax(e.a.x, e.b.x) : std::minmax(e.a.y, e.b.y);
  };
  std::vector<std::pair<double, double>> spans;
  for (const Element& e : elements) {
    if (kernel::orient2d(a, b, e.a) == 0 && kernel::orient2d(a, b, e.b) == 0) spans.push_back(along(e));
  }
  std::sort(spans.begin(), spans.end());
  auto [reached, end] = std::pair<double, double>(along(segment));
  for (const auto& [first, last] : spans) {
    if (first > reached) return false;
    reached = std::max(reached, last);
    if (reached >= end) return true;
  }
  return false;
}

namespace {

// How much farther e is than f, as squares.
struct Difference {
  const Element& segment;
  const Element& e;
  const Element& f;

  double operator()(double share) const {
    const Point p = segment.at(share);
    return square_distance(e, p) - square_distance(f, p);
  }
};

// The shares at which the nearest place of an element begins to move along it, and ends to: there the square
// of the distance goes over from one polynomial into another.
void add_joints(const Element& segment, const Element& element, double* joints) {
  const Point u = segment.b - segment.a, v = element.b - element.a;
  const double speed = kernel::dot(u, v);
  for (int i = 0; i < 2; ++i) {
    const double way = kernel::dot((i == 0 ? element.a : element.b) - segment.a, v);
    joints[i] = speed == 0 ? -1 : way / speed;
  }
}

// The root in [0, 1] of the parabola with these values at 0, 1/2 and 1, of which the first is not positive
// and the last not negative.
double root_of(double at_0, double at_half, double at_1) {
  const double a = 2 * (at_0 + at_1 - 2 * at_half), b = at_1 - at_0 - a, c = at_0;
  const double discriminant = std::max(b * b - 4 * a * c, 0.0);
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  double best = at_0 == 0 ? 0 : at_1 == 0 ? 1 : 0.5;
  double least = std::min(std::abs(at_0), std::abs(at_1));
  for (const double root : {c / q, q / a}) {
    if (!(root >= 0 && root <= 1)) continue;
    const double value = std::abs((a * root + b) * root + c);
    if (value <= least) {
      best = root;
      least = value;
    }
  }
  return best;
}

}  // namespace

double equally_far(const Element& segment, const Element& e, const Element& f, double s, double t) {
  const Difference difference{segment, e, f};
  std::array<double, 4> joints;
  add_joints(segment, e, joints.data());
  add_joints(segment, f, joints.data() + 2);
  std::sort(joints.begin(), joints.end());
  double at_s = difference(s), at_t = difference(t);
  for (const double joint : joints) {
    if (!(joint > s && joint < t)) continue;
    const double value = difference(joint);
    if (value > 0) {
      t = joint;
      at_t = value;
      break;
    }
    s = joint;
    at_s = value;
  }
  const double half = difference(s + 0.5 * (t - s));
  return s + (t - s) * root_of(std::min(at_s, 0.0), half, std::max(at_t, 0.0));
}

}  // namespace vorotool::core::distances
