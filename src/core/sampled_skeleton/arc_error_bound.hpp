// How far a straight arc between two seeds may be from the exact skeleton: a bound for all of its points.
//
// Let C be the edge nearest to a point q of the arc, f its foot there, d = |q - f|, n = (q - f) / d. The disc
// about q through f is empty.
//
// 1. While q moves along n, the disc that touches C in f grows, until it meets a place g of another edge:
//    then its center is on the skeleton. For any place g of the boundary that is so after
//      t = (|q - g|^2 - d^2) / (2 h),    h = n (g - f) the height of g over the line of C,
//    at the latest. Along the arc |q - g|^2 - d^2 is convex, so that t is largest at an end.
//
// 2. The place nearest to a moving point moves no faster than it does, unless it crosses the skeleton: feet
//    on edges are projections, and reflex corners stay. So if y is e away from q, no farther than d, and what is
//    nearest to y is more than e away from f, the skeleton passes between. Let y be where another edge D, or
//    a seed of it, becomes as near as the line of C. If f is more than e away from the ends of C and from all
//    other edges on the side of q, what is nearest to y is farther from f, or on C and elsewhere at once. On
//    the way along n - n', y is
//      e = (d' - d) / |n - n'|
//    away for a foot inside D, d' from q, with n' as n is for C; e is linear along the arc. For a seed g,
//    with n' = (q - g) / d', it is the smaller root of
//      (1 - s^2/4) e^2 - s (d + d') e + (d'^2 - d^2) = 0,    s = |n - n'|.
//
// If no edge is nearer than the seeds of the arc, q itself is on the skeleton.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/kernel/lattice.hpp"
#include "core/kernel/point.hpp"
#include "core/skeleton/bisector_arc.hpp"

namespace vorotool::core::sampled_skeleton {

// Of p from the segment between a and b.
double closed_distance(const kernel::Point& p, const kernel::Point& a, const kernel::Point& b);

// A closed edge near an arc, or a point of the graph that is on none.
struct NearEdge {
  std::int32_t segment;  // -1 of a point
  kernel::LatticeSite site;
};

// A seed of an arc.
struct ArcSample {
  kernel::Point place;
  std::span<const std::int32_t> labels;  // segments that it is on
};

// Bounds arcs one after the other: memory is used again.
class ArcErrorBound {
 public:
  // How far edges but one are from the places between two on this, or less; no matter where it is more than
  // the reach.
  using Clearing =
      std::function<double(const kernel::Point&, const kernel::Point&, std::int32_t segment, double reach)>;

  // `near` holds all edges that may be nearest to a point of the arc. All ends of edges, and points without,
  // are seeds, and none is nearer to a point of the arc than its own. An arc without seeds need not be
  // equally far from any. The errors of the second kind are proved up to `reach`. Infinite where nothing is
  // proved.
  double operator()(const kernel::Point& source, const kernel::Point& target,
                    std::span<const ArcSample> seeds, std::span<const NearEdge> near, double reach,
                    const Clearing& clearing);

  // Of the distances of other edges among those given.
  static Clearing clearing_among(std::span<const NearEdge> near);

 private:
  // An edge as it is seen from the arc: distances of its line from the ends, and feet along it.
  struct Seen {
    kernel::Point a, way;  // its first end, and the unit vector along it
    double length;         // 0 of a point
    double error;          // of distances and feet
    std::array<double, 2> height, foot;
    std::int32_t segment;
  };
  // The part of the arc, by its parameter, where an edge may be the nearest.
  struct Stretch {
    double from, to;
  };

  struct Nearest;

  void see(const kernel::Point& source, const kernel::Point& target, std::span<const NearEdge> near);
  bool stretch_of(const Seen& c, Stretch& part) const;
  double bound_by(const Nearest& c, const Stretch& part, std::span<const ArcSample> seeds) const;
  static double bound_by_edge(const Nearest& c, const Seen& d, const Stretch& part);
  static double bound_by_seed(const Nearest& c, const kernel::Point& g);

  std::vector<Seen> seen_;
};

}  // namespace vorotool::core::sampled_skeleton
