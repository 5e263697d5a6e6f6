// Along an arc of a skeleton: places, radii, and where a length ends.
#pragma once

#include <cstddef>

#include "core/kernel/point.hpp"
#include "core/skeleton/skeleton_view.hpp"

namespace vorotool::core::skeleton {

// By the parameter u of the Bezier curve that the arc is, from 0 at its source to 1 at its target.
//
// These are the formulas of types/skeleton/arc_measures.py, operation by operation: the slope of a
// parabola against its directrix is linear in u, and its ends follow from the radii and the height of the
// Bezier triangle; between two vertices the radius is the root of c^2 + x^2; else it is linear.
class ArcCourse {
 public:
  ArcCourse(const SkeletonView& skeleton, std::size_t arc);

  kernel::Point place(double u) const;
  double radius(double u) const;
  // Where the part from the source has this length.
  double at_length(double distance) const;

 private:
  double slope(double u) const { return slope0_ + u * (slope1_ - slope0_); }

  kernel::Point source_, target_, control_;
  double r0_, r1_, length_;
  double along_ = 0, half_ = 0, slope0_ = 0, slope1_ = 0;
  bool is_parabola_, is_parting_;
};

// The mean of sqrt(1 + x^2) for x from s to t, by sums of positive numbers.
double mean_root(double s, double t);

}  // namespace vorotool::core::skeleton
