#include "core/skeleton/clearance_course.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <optional>

#include "core/base/parallel.hpp"
#include "core/numbers/sign.hpp"
#include "core/numbers/special_values.hpp"
#include "core/segment_voronoi/discs/exact_signs.hpp"

namespace vorotool::core::skeleton {
using numbers::nan;

namespace {

using base::at;
using kernel::cross;
using kernel::dot;
using kernel::LatticePoint;
using kernel::LatticeSite;
using kernel::LatticeVector;
using kernel::left_of;
using kernel::Point;
using numbers::sign_of;

constexpr std::size_t courses_a_piece = 1 << 12;  // arcs a piece: a millisecond or so
// Radii that differ by more of their sum differ: each has a relative error of 2^-49 at most
// (core/segment_voronoi/build/refined_disc.cpp), and powers of two place it.
constexpr double apart = 0x1p-47;

double magnitude(std::int64_t value) { return std::abs(static_cast<double>(value)); }

// The sites that the disc of each node is known to touch: those of the arcs there, each once.
class NodeSites {
 public:
  explicit NodeSites(const PlacedSkeleton& skeleton) : start_(skeleton.vertices.size() + 1) {
    for (const auto& arc : skeleton.arcs) {
      for (const std::int32_t node : arc) start_[at(node) + 1] += 2;
    }
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    sites_.resize(start_.back());
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for (std::size_t k = 0; k < skeleton.arcs.size(); ++k) {
      for (const std::int32_t node : skeleton.arcs[k]) {
        for (const std::int32_t site : skeleton.sites[k]) sites_[next[at(node)]++] = site;
      }
    }
  }

  // Some more than once.
  std::span<const std::int32_t> of(std::int32_t node) const {
    return std::span(sites_).subspan(start_[at(node)], start_[at(node) + 1] - start_[at(node)]);
  }

 private:
  std::vector<std::size_t> start_;
  std::vector<std::int32_t> sites_;
};

// An end of an arc, seen from its node: the disc touches the right site, the left one, and then all others.
struct ArcEndSites {
  std::int32_t node, left, right;
};

class Courses {
 public:
  Courses(const PlacedSkeleton& skeleton, ClearanceCourse& out)
      : skeleton_(skeleton), node_sites_(skeleton), out_(out) {}

  void write(std::size_t arc) {
    const auto [source, target] = skeleton_.arcs[arc];
    const auto [left, right] = skeleton_.sites[arc];
    const std::array<ArcEndSites, 2> ends{{{source, left, right}, {target, right, left}}};
    if (is_one_place(ends)) return;
    const LatticeSite &l = place(left), &r = place(right);
    if (l.is_point() && r.is_point()) {
      around_apex(arc, ends, l.a, -left_of(l.a - r.a));
    } else if (l.is_point() || r.is_point()) {
      on_parabola(arc, ends, l, r);
    } else {
      between_lines(arc, ends, l, r);
    }
  }

 private:
  const LatticeSite& place(std::int32_t site) const { return skeleton_.site_places[at(site)]; }
  double radius(const ArcEndSites& end) const { return skeleton_.radius[at(end.node)]; }

  // What is left of a skeleton that was pruned as far as can be.
  bool is_one_place(const std::array<ArcEndSites, 2>& ends) const {
    const Point &a = skeleton_.vertices[at(ends[0].node)], &b = skeleton_.vertices[at(ends[1].node)];
    return a.x == b.x && a.y == b.y && radius(ends[0]) == radius(ends[1]) && !third_site(ends[0]) &&
           !third_site(ends[1]);
  }

  std::optional<std::int32_t> third_site(const ArcEndSites& end) const {
    for (const std::int32_t site : node_sites_.of(end.node)) {
      if (site != end.left && site != end.right) return site;
    }
    return std::nullopt;
  }

  void grow(std::size_t arc, int sign) {
    out_.slope[arc] = {static_cast<std::int8_t>(sign), static_cast<std::int8_t>(-sign)};
  }
  // 0 where their errors may be larger.
  int sign_by_radii(const std::array<ArcEndSites, 2>& ends) const {
    const double a = radius(ends[0]), b = radius(ends[1]);
    const double error = skeleton_.sites_are_exact ? apart * (a + b) : 2 * skeleton_.error;
    return std::abs(b - a) > error ? sign_of(b - a) : 0;
  }
  void compare_radii(std::size_t arc, const std::array<ArcEndSites, 2>& ends) {
    grow(arc, sign_of(radius(ends[1]) - radius(ends[0])));
  }

  // With the normals n towards the arc its direction is left_of(n - n'), n that of the left line, on which the
  // clearance grows by n x n'.
  void between_lines(std::size_t arc, const std::array<ArcEndSites, 2>& ends, const LatticeSite& l,
                     const LatticeSite& r) {
    const LatticeVector u = l.b - l.a, v = r.b - r.a;
    const std::int64_t turn = cross(u, v);
    if (turn == 0) {
      if (cross(u, r.a - l.a) == 0) compare_radii(arc, ends);
      return;
    }
    if (const int sign = sign_by_radii(ends)) return grow(arc, sign);
    const ArcEndSites& larger = ends[radius(ends[0]) < radius(ends[1]) ? 1 : 0];
    const int sides = side_of_line(l, r, larger) * side_of_line(r, l, larger);
    if (sides != 0) return grow(arc, sides * sign_of(turn));
    compare_radii(arc, ends);
  }

  // On which side of a line an arc is whose other site is on one side of it, or whose node tells.
  int side_of_line(const LatticeSite& line, const LatticeSite& other, const ArcEndSites& end) const {
    const LatticeVector u = line.b - line.a;
    const int a = sign_of(cross(u, other.a - line.a)), b = sign_of(cross(u, other.b - line.a));
    return a * b < 0 ? side(end, line.a, left_of(u), false) : a + b < 0 ? -1 : 1;
  }

  void on_parabola(std::size_t arc, const std::array<ArcEndSites, 2>& ends, const LatticeSite& l,
                   const LatticeSite& r) {
    const LatticePoint& focus = l.is_point() ? l.a : r.a;
    const LatticeSite& line = l.is_point() ? r : l;
    const LatticeVector u = line.b - line.a;
    const int side_of_focus = sign_of(cross(u, focus - line.a)) * (l.is_point() ? 1 : -1);
    if (side_of_focus == 0) return compare_radii(arc, ends);  // across the line, from its end
    around_apex(arc, ends, focus, side_of_focus > 0 ? u : -u);
  }

  // The apex is where (center - point) * direction is 0; the arc goes along the direction.
  void around_apex(std::size_t arc, const std::array<ArcEndSites, 2>& ends, const LatticePoint& point,
                   const LatticeVector& direction) {
    const int first = radius(ends[0]) > 0 ? side(ends[0], point, direction, true) : 0;
    const int last = radius(ends[1]) > 0 ? side(ends[1], point, direction, true) : 0;
    if (first >= 0) return grow(arc, 1);
    if (last <= 0) return grow(arc, -1);
    out_.slope[arc] = {-1, -1};
    const double a = along(ends[0].node, point, direction), b = along(ends[1].node, point, direction);
    out_.least[arc] = std::clamp(a / (a - b), 0.0, 1.0);
  }

  double along(std::int32_t node, const LatticePoint& point, const LatticeVector& direction) const {
    const Point& c = skeleton_.vertices[at(node)];
    return (c.x - point.x) * static_cast<double>(direction.x) +
           (c.y - point.y) * static_cast<double>(direction.y);
  }

  // The sign of (center - point) * direction. The differences err by that of the center and a rounding, the products
  // by that of the direction and their own, the sum by one more: less than 6 u of the products in all.
  int side(const ArcEndSites& end, const LatticePoint& point, const LatticeVector& direction,
           bool touches_point) const {
    const Point& c = skeleton_.vertices[at(end.node)];
    const double value = along(end.node, point, direction);
    const double x = magnitude(direction.x), y = magnitude(direction.y);
    const double error =
        1.0001 * (skeleton_.error * (x + y)) +
        8 * numbers::unit_roundoff * (std::abs(c.x - point.x) * x + std::abs(c.y - point.y) * y);
    if (std::abs(value) > error) return sign_of(value);
    return skeleton_.sites_are_exact ? exact_side(end, point, direction, touches_point) : 0;
  }

  int exact_side(const ArcEndSites& end, const LatticePoint& point, const LatticeVector& direction,
                 bool touches_point) const {
    const auto sites = node_sites_.of(end.node);
    const auto is_third = [&](std::int32_t site) { return site != end.left && site != end.right; };
    // A disc that touches a segment at its end has its center across it from there.
    for (const std::int32_t site : sites) {
      const LatticeSite& q = place(site);
      if (touches_point && !q.is_point() && (q.a == point || q.b == point) && is_third(site) &&
          dot(left_of(q.b - q.a), direction) == 0) {
        return 0;
      }
    }
    for (const std::int32_t site : sites) {
      if (!is_third(site)) continue;
      const std::array<LatticeSite, 3> triple{place(end.right), place(end.left), place(site)};
      const auto disc = segment_voronoi::discs::find_exact_disc(triple);
      if (disc && is_at(*disc, end.node)) {
        return segment_voronoi::discs::side_of_center(*disc, point, direction);
      }
    }
    return 0;
  }

  bool is_at(const segment_voronoi::discs::ExactDisc& disc, std::int32_t node) const {
    const Point& c = skeleton_.vertices[at(node)];
    const auto found = segment_voronoi::discs::rounded(disc);
    const double error = 2 * skeleton_.error;
    return std::abs(found.x - c.x) <= error && std::abs(found.y - c.y) <= error;
  }

  const PlacedSkeleton& skeleton_;
  NodeSites node_sites_;
  ClearanceCourse& out_;
};

}  // namespace

ClearanceCourse clearance_course(const PlacedSkeleton& skeleton, unsigned threads,
                                 const base::Monitor& monitor) {
  const std::size_t count = skeleton.arcs.size();
  ClearanceCourse out{std::vector<std::array<std::int8_t, 2>>(count), std::vector<double>(count, nan)};
  Courses courses(skeleton, out);
  base::for_items(count, courses_a_piece, threads, monitor, [&](std::size_t arc) { courses.write(arc); });
  return out;
}

}  // namespace vorotool::core::skeleton
