#include "core/segment_voronoi/verify/verify_edges.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/radix_sort.hpp"
#include "core/kernel/lattice.hpp"
#include "core/numbers/sign.hpp"
#include "core/segment_voronoi/discs/exact_signs.hpp"
#include "core/segment_voronoi/verify/verify_segment_voronoi.hpp"
#include "core/segment_voronoi/verify/verify_vertices.hpp"

namespace vorotool::core::segment_voronoi::verify {

using base::Fault;
using base::Keyed;
using build::DiagramView;
using build::IncidentSegments;
using kernel::cross;
using kernel::LatticePoint;
using kernel::LatticeSite;
using kernel::LatticeVector;
using kernel::left_of;
using kernel::Point;

namespace {

using Site = std::int32_t;

std::string edge_text(std::size_t edge) { return "edge " + std::to_string(edge); }

// The order along a bisector.

// The edges between the cells of two sites, each taken with the smaller number on its left.
class Bisector {
 public:
  Bisector(const DiagramView& arrays, const IncidentSegments& incident, std::size_t edge)
      : in_(arrays),
        incident_(incident),
        left_(std::min(arrays.edge_sites[edge][0], arrays.edge_sites[edge][1])),
        right_(std::max(arrays.edge_sites[edge][0], arrays.edge_sites[edge][1])) {}

  // Bisectors of two segments may have two branches, on different sides of them.
  Fault check(std::span<const Keyed> edges) {
    std::map<int, std::vector<std::size_t>> branches;
    for (const Keyed& keyed : edges) branches[branch_of(keyed.value)].push_back(keyed.value);
    for (auto& [branch, members] : branches) {
      if (Fault fault = check_branch(members, direction(branch))) return fault;
    }
    return {};
  }

 private:
  Site start_of(std::size_t edge) const { return in_.edges[edge][in_.edge_sites[edge][0] == left_ ? 0 : 1]; }
  Site end_of(std::size_t edge) const { return in_.edges[edge][in_.edge_sites[edge][0] == left_ ? 1 : 0]; }

  // Places along the direction grow on the way along the bisector with the left site on its left.
  Fault check_branch(std::vector<std::size_t>& edges, const LatticeVector& direction) const {
    std::sort(edges.begin(), edges.end(), [&](std::size_t e, std::size_t f) {
      const Site a = start_of(e), b = start_of(f);
      if (a < 0 || b < 0) return a < 0 && b >= 0;
      return a != b && compare(a, b, direction) < 0;
    });
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const Site start = start_of(edges[i]), end = end_of(edges[i]);
      if (start >= 0 && end >= 0 && compare(start, end, direction) >= 0) {
        return edge_text(edges[i]) + " runs backwards along the bisector of its sites";
      }
      if (i + 1 == edges.size()) break;
      const Site next = start_of(edges[i + 1]);
      if (end < 0 || next < 0 || compare(end, next, direction) >= 0) {
        return edge_text(edges[i]) + " and " + edge_text(edges[i + 1]) +
               " overlap on the bisector of their sites";
      }
    }
    return {};
  }

  // The sign of the difference of two vertices' places: values are right to `value_error_bound`.
  int compare(Site v, Site w, const LatticeVector& u) const {
    const double ux = static_cast<double>(u.x), uy = static_cast<double>(u.y);
    double place[2], size = 0;
    for (int i = 0; i < 2; ++i) {
      const auto k = static_cast<std::size_t>(i == 0 ? v : w);
      const double x = in_.vertices[k].x, y = in_.vertices[k].y;
      place[i] = ux * x + uy * y;
      size += std::abs(x) + std::abs(y) + in_.radius[k];
    }
    const double difference = place[0] - place[1];
    if (std::abs(difference) > 0x1p-46 * size * (std::abs(ux) + std::abs(uy))) return difference > 0 ? 1 : -1;
    return discs::compare_along(disc(v), disc(w), u);
  }

  discs::ExactDisc disc(Site vertex) const {
    return exact_disc_of(in_, incident_, static_cast<std::size_t>(vertex));
  }

  // Bit 0: the edge is to the left of the left site, bit 1: of the right one; 0 unless both are segments.
  int branch_of(std::size_t edge) const {
    if (in_.is_point(left_) || in_.is_point(right_)) return 0;
    const Site vertex = std::max(in_.edges[edge][0], in_.edges[edge][1]);  // one is finite: segments end
    return (side_of(left_, vertex) > 0 ? 1 : 0) + (side_of(right_, vertex) > 0 ? 2 : 0);
  }

  int side_of(Site segment, Site vertex) const {
    const LatticeSite s = in_.site(segment);
    const auto k = static_cast<std::size_t>(vertex);
    if (in_.radius[k] == 0) return side_at_corner(s);
    const LatticeVector u = s.b - s.a;
    const double x = in_.vertices[k].x - s.a.x, y = in_.vertices[k].y - s.a.y;
    const double ux = static_cast<double>(u.x), uy = static_cast<double>(u.y);
    const double height = ux * y - uy * x;
    const double size =
        std::abs(in_.vertices[k].x) + std::abs(in_.vertices[k].y) + std::abs(x) + std::abs(y) + in_.radius[k];
    if (std::abs(height) > 0x1p-46 * size * (std::abs(ux) + std::abs(uy))) return height > 0 ? 1 : -1;
    const LatticeVector across = left_of(u);
    const discs::ExactDisc end{std::make_shared<numbers::SqrtTower>(), s.a, 0, 0, 1, 0};
    return discs::compare_along(disc(vertex), end, across);
  }

  // Two segments meet in a corner: their bisector runs inside their sector.
  int side_at_corner(const LatticeSite& s) const {
    const LatticeSite a = in_.site(left_), b = in_.site(right_);
    const LatticePoint& corner = a.a == b.a || a.a == b.b ? a.a : a.b;
    auto way = [&](const LatticeSite& t) { return corner == t.a ? t.b - t.a : t.a - t.b; };
    const LatticeVector ways[] = {way(a), way(b)};
    // a point inside the sector is corner + ways[0] + ways[1], and s goes through the corner
    return numbers::sign_of(cross(s.b - s.a, ways[0])) + numbers::sign_of(cross(s.b - s.a, ways[1]));
  }

  LatticeVector direction(int branch) const {
    const LatticeSite left = in_.site(left_), right = in_.site(right_);
    if (right.is_point()) return -left_of(left.a - right.a);
    const LatticeVector u = right.b - right.a;
    if (!left.is_point()) return (branch & 2) != 0 ? u : -u;
    if (in_.is_end(left_, right_)) return left_of(left.a == right.a ? u : -u);
    return cross(u, left.a - right.a) > 0 ? u : -u;
  }

  const DiagramView& in_;
  const IncidentSegments& incident_;
  Site left_, right_;
};

}  // namespace

Fault find_order_fault(const DiagramView& arrays, const IncidentSegments& incident) {
  const std::uint64_t sites = arrays.site_count();
  std::vector<Keyed> keys;
  keys.reserve(arrays.edges.size());
  for (std::size_t i = 0; i < arrays.edges.size(); ++i) {
    const auto [smaller, larger] = std::minmax(arrays.edge_sites[i][0], arrays.edge_sites[i][1]);
    keys.push_back({static_cast<std::uint64_t>(smaller) * sites + static_cast<std::uint64_t>(larger),
                    static_cast<std::uint32_t>(i)});
  }
  base::radix_sort(keys, std::bit_width(sites * sites));
  for (std::size_t i = 0, end = 0; i < keys.size(); i = end) {
    while (end < keys.size() && keys[end].key == keys[i].key) ++end;
    if (end == i + 1) continue;
    Bisector bisector(arrays, incident, keys[i].value);
    if (Fault fault = bisector.check(std::span(keys).subspan(i, end - i))) return fault;
  }
  return {};
}

namespace {

// Points inside edges.

class InnerPoints {
 public:
  InnerPoints(const DiagramView& arrays, const ClosedSites& index) : in_(arrays), index_(index) {
    for (const LatticePoint& p : arrays.points) {
      extent_ = std::max({extent_, std::abs(static_cast<double>(p.x)), std::abs(static_cast<double>(p.y))});
    }
  }

  Fault check(std::size_t edge) const {
    const auto [source, target] = in_.edges[edge];
    for (const double part : {0.375, 0.75}) {
      const Point place = source < 0 || target < 0 ? place_on_ray(edge, part) : place_between(edge, part);
      if (Fault fault = check_place(edge, place)) return fault;
    }
    return {};
  }

 private:
  const Point& center(Site vertex) const { return in_.vertices[base::at(vertex)]; }

  Point place_between(std::size_t edge, double part) const {
    const auto [left, right] = in_.edge_sites[edge];
    const Point a = center(in_.edges[edge][0]), b = center(in_.edges[edge][1]);
    if (in_.is_point(left) != in_.is_point(right)) {
      const Site point = in_.is_point(left) ? left : right, segment = point == left ? right : left;
      if (!in_.is_end(point, segment)) return place_on_parabola(point, segment, a, b, part);
    }
    return {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)};
  }

  // With the segment along the x axis and the point at (0, h): y = (x^2 + h^2) / (2 h).
  Point place_on_parabola(Site point, Site segment, const Point& from, const Point& to, double part) const {
    const LatticeSite s = in_.site(segment);
    const LatticePoint& p = in_.point(point);
    const LatticeVector u = s.b - s.a;
    const double length = std::sqrt(static_cast<double>(kernel::norm2(u)));
    const double ux = static_cast<double>(u.x) / length, uy = static_cast<double>(u.y) / length;
    const double h = static_cast<double>(cross(u, p - s.a)) / length;
    auto along = [&](const Point& c) { return ux * (c.x - p.x) + uy * (c.y - p.y); };
    const double x = along(from) + part * (along(to) - along(from));
    const double up = (x * x / h - h) / 2;  // y less h
    return {p.x + ux * x - uy * up, p.y + uy * x + ux * up};
  }

  // Edges go to infinity across the line of two points, or across a segment from its end.
  Point place_on_ray(std::size_t edge, double part) const {
    const auto [left, right] = in_.edge_sites[edge];
    const LatticeSite l = in_.site(left), r = in_.site(right);
    const auto outwards_x = static_cast<double>((l.a - r.a).y + (l.b - r.b).y);
    const auto outwards_y = -static_cast<double>((l.a - r.a).x + (l.b - r.b).x);
    const auto [source, target] = in_.edges[edge];
    const double scale = extent_ * 4 * (part - (source < 0 && target < 0 ? 0.4 : 0)) *
                         (source < 0 && target >= 0 ? -1 : 1) / length(outwards_x, outwards_y);
    const Point start = source >= 0 ? center(source) : target >= 0 ? center(target) : middle(left, right);
    return {start.x + scale * outwards_x, start.y + scale * outwards_y};
  }

  Point middle(Site left, Site right) const {
    if (!in_.is_point(left)) return middle(right, left);
    const LatticePoint &p = in_.point(left), &q = in_.is_point(right) ? in_.point(right) : p;
    return {0.5 * p.x + 0.5 * q.x, 0.5 * p.y + 0.5 * q.y};
  }

  static double length(double x, double y) { return std::sqrt(x * x + y * y); }

  double distance(const Point& c, Site site) const {
    const LatticeSite s = in_.site(site);
    if (s.is_point()) return length(c.x - s.a.x, c.y - s.a.y);
    const auto ux = static_cast<double>((s.b - s.a).x), uy = static_cast<double>((s.b - s.a).y);
    const double ax = c.x - s.a.x, ay = c.y - s.a.y, bx = c.x - s.b.x, by = c.y - s.b.y;
    if (ux * ax + uy * ay <= 0) return length(ax, ay);
    if (ux * bx + uy * by >= 0) return length(bx, by);
    return std::abs(ux * ay - uy * ax) / length(ux, uy);
  }

  // The ends of the edge are wrong by `value_error_bound`, the rest by a few roundings.
  Fault check_place(std::size_t edge, const Point& place) const {
    const auto [left, right] = in_.edge_sites[edge];
    const double r = distance(place, left), other = distance(place, right);
    double size = std::abs(place.x) + std::abs(place.y) + r + extent_;
    for (const Site v : in_.edges[edge]) {
      if (v >= 0)
        size += std::abs(center(v).x) + std::abs(center(v).y) + in_.radius[static_cast<std::size_t>(v)];
    }
    const double tolerance = 0x1p-44 * size;
    if (std::abs(r - other) > tolerance)
      return fault(edge, place, "is not as far from one site as from the other");
    Fault found;
    if (r <= tolerance) return found;
    index_.near(place.x, place.y, r, [&](Site site) {
      if (distance(place, site) < r - tolerance) {
        found = fault(edge, place, "is nearer to site " + std::to_string(site) + " than to its own");
      }
      return !found;
    });
    return found;
  }

  Fault fault(std::size_t edge, const Point& place, const std::string& what) const {
    const auto [left, right] = in_.edge_sites[edge];
    return edge_text(edge) + " of sites " + std::to_string(left) + " and " + std::to_string(right) +
           ": its inner point (" + std::to_string(place.x) + ", " + std::to_string(place.y) + ") " + what;
  }

  const DiagramView& in_;
  const ClosedSites& index_;
  double extent_ = 1;
};

}  // namespace

Fault find_inner_point_fault(const DiagramView& arrays, const ClosedSites& index, unsigned threads,
                             const base::Monitor& monitor) {
  const InnerPoints points(arrays, index);
  return base::first_fault(
      arrays.edges.size(), [&](std::size_t edge) { return points.check(edge); }, threads, monitor);
}

}  // namespace vorotool::core::segment_voronoi::verify
