// Along an arc of a skeleton: the angle under which a center sees its two feet, the chord between them, the
// radius, and the length.
#pragma once

#include <cstddef>

#include "core/kernel/point.hpp"
#include "core/skeleton/skeleton_view.hpp"

namespace vorotool::core::pruning {

// Where u goes from 0 at the source to 1 at the target, the parameter of the Bezier curve that the arc is.
//
// Between two lines the angle is constant, and the radius linear. Else there is a middle: below the focus of
// a parabola, or half-way between two points. Let h be the distance of the focus from the directrix, or half
// of that between the points, and h x the distance from the middle, along the directrix or across the two.
// Then the radius is h (1 + x^2) / 2 or h sqrt(1 + x^2), the chord h sqrt(1 + x^2) or 2 h, half their
// quotient the sine of half the angle, so that cot(angle / 2) = |x|; and x is linear in u.
class ArcProfile {
 public:
  ArcProfile(const skeleton::SkeletonView& skeleton, std::size_t arc);

  // A quantity along the arc.
  struct Course {
    double at_source, at_target, most;
    double peak;  // a parameter where it is largest; of several one where the radius is largest
  };
  Course angle() const;  // the tangent of half of it: infinite where the feet are opposite
  Course chord() const;

  // Where a value is reached first, seen from the source or the target, which have less; some place has as
  // much.
  double angle_reached(double value, bool from_target) const;
  double chord_reached(double value, bool from_target) const;

  double radius(double u) const;
  double length(double u0, double u1) const;

  // The parameter at a distance along the arc from its source.
  double at_length(double distance) const;

  enum class Kind : std::int8_t { lines, points, parabola };
  Kind kind;
  double from = 0, to = 0;  // x at the ends, but between two lines
  double size;              // h; between two lines the tangent of half the angle

 private:
  void between_lines(const std::array<kernel::Point, 2>& left, const std::array<kernel::Point, 2>& right,
                     const kernel::Point& middle);
  void between_points(const kernel::Point& left, const kernel::Point& right, const skeleton::ArcEnd& source,
                      const skeleton::ArcEnd& target);
  void from_focus(const kernel::Point& focus, const std::array<kernel::Point, 2>& line,
                  const skeleton::ArcEnd& source, const skeleton::ArcEnd& target);
  double x(double u) const { return from + u * (to - from); }
  double chord_at(double x, double radius) const;
  bool source_is_larger() const { return radius_[0] >= radius_[1]; }

  bool is_curved_;
  double radius_[2];
  double length_;
};

}  // namespace vorotool::core::pruning
