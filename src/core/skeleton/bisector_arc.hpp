// A piece of the bisector of two sites: a straight line, or a part of a parabola (paper, section 3.2).
#pragma once

#include "core/kernel/lattice.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::skeleton {

// The end of an arc: the center of a disc that touches both sites.
struct ArcEnd {
  kernel::Point place;
  double radius;
};

// A parabola about a focus, in units of its own: t along the directrix from below the focus, h the distance
// of the focus from the directrix. The distance from both is (t^2 + h^2) / (2 h).
struct Parabola {
  kernel::Point focus;
  double ux, uy;  // along the directrix, the focus to its left
  double h;

  // Along the directrix. The place tells t to a few ulp of the coordinates; where the radius tells
  // more, as on the steep sides of a sharp parabola, that counts.
  double parameter(const ArcEnd& end) const;
  kernel::Point place(double t) const;
  double radius(double t) const { return (t * t + h * h) / (2 * h); }
};

struct BisectorArc {
  BisectorArc(const kernel::LatticeSite& left, const kernel::LatticeSite& right);

  bool is_parabola;
  Parabola parabola;
};

// Where the tangents at both ends meet: the control point of the quadratic Bezier that the arc is.
kernel::Point control_point(const Parabola& parabola, const ArcEnd& source, const ArcEnd& target);

double arc_length(const Parabola& parabola, const ArcEnd& source, const ArcEnd& target);

// Of the part of a parabola between two parameters, by h alone.
double arc_length(double h, double from, double to);

// The distance of a place from a site whose closest point is within the segment.
double distance_to(const kernel::LatticeSite& site, const kernel::Point& place);

}  // namespace vorotool::core::skeleton
