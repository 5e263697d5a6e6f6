#include "core/segment_voronoi/build/insertion_predicates.hpp"

#include <cmath>
#include <optional>

#include "core/numbers/sign.hpp"
#include "core/segment_voronoi/discs/dyadic_disc.hpp"
#include "core/segment_voronoi/discs/exact_signs.hpp"
#include "core/segment_voronoi/discs/ties.hpp"

namespace vorotool::core::segment_voronoi::build {

using discs::SegmentSite;
using discs::SiteIndex;
using discs::VoronoiRecord;
using kernel::cross;
using kernel::dot;
using kernel::LatticePoint;
using kernel::LatticeVector;
using numbers::DoubleDouble;
using numbers::int128;
using numbers::undecided;
using numbers::unit_roundoff;

namespace {

// The center of a disc seen from a lattice point, along and to the left of a direction d: (c - p) . d and
// d x (c - p), with a bound of the error of either. Each is a sum of three terms, which meet at most 4
// roundings.
struct Offset {
  DoubleDouble along, across;
  double error;
};

Offset offset_of(const discs::TangentDisc<DoubleDouble>& disc, const LatticePoint& p, const LatticeVector& d,
                 double length) {
  const auto real = [](std::int64_t value) { return DoubleDouble(int128{value}); };
  const LatticeVector w = disc.anchor - p;
  const DoubleDouble dx = real(d.x), dy = real(d.y);
  const double size = std::abs(disc.x.head) + std::abs(disc.y.head) + std::abs(static_cast<double>(w.x)) +
                      std::abs(static_cast<double>(w.y));
  return {disc.x * dx + disc.y * dy + real(dot(d, w)), disc.y * dx - disc.x * dy + real(cross(d, w)),
          length * (disc.position_error + 8 * discs::roundoff<DoubleDouble> * size)};
}

int sign_beyond(const DoubleDouble& value, double error) {
  if (value.head > error) return 1;
  return value.head < -error ? -1 : undecided;
}

// As InsertionPredicates::sign, for a disc that does not touch the ends of the query.
int clearance_sign(const discs::TangentDisc<DoubleDouble>& disc, const SegmentSite& s) {
  const LatticeVector d = s.direction();
  const Offset offset = offset_of(disc, s.a, d, s.length);
  const DoubleDouble length = numbers::sqrt(DoubleDouble(int128{dot(d, d)}));
  const DoubleDouble reach = disc.radius * length;
  const double error =
      offset.error + s.length * disc.radius_error + 16 * discs::roundoff<DoubleDouble> * reach.head;
  const int sign = sign_beyond(numbers::abs(offset.across) - reach, error);
  if (sign != -1) return sign;
  // The line enters the disc, along a chord that holds neither end; half of it is longer than the error of
  // the foot: (reach - |across|) (reach + |across|) > error reach > error^2. Doubles would not do: the foot
  // may be nearer to an end than they tell.
  const bool between = offset.along.head > 0 && (DoubleDouble(int128{dot(d, d)}) - offset.along).head > 0;
  return between ? -1 : 1;
}

// Where the center of a vertex is, seen from a lattice point along a unit vector, and to the left of it. The
// error is that of InsertionPredicates::sign.
struct Sighting {
  Sighting(const VoronoiRecord& v, const LatticePoint& p, double ux, double uy) {
    const double dx = v.x - p.x, dy = v.y - p.y;
    along = ux * dx + uy * dy;
    across = ux * dy - uy * dx;
    error = static_cast<double>(v.position_error) + 7 * unit_roundoff * (std::abs(dx) + std::abs(dy));
  }
  double along, across, error;
};

// Whether y is surely beyond (1) or before (-1) a place known with an error.
int beyond(double y, double place, double error) {
  return y - place > error ? 1 : y - place < -error ? -1 : undecided;
}

// Whether an edge that goes from one place to another along an axis crosses a third one.
int crosses(int from, int to) {
  if (from == 1 || to == -1) return -1;
  return from == undecided || to == undecided ? undecided : 1;
}

}  // namespace

int InsertionPredicates::sign(const VoronoiRecord& v, const SegmentQuery& query) {
  const int at_p = v.find(query.p), at_q = v.find(query.q);
  if (v.is_infinite()) return at_p >= 0 && at_q >= 0 ? -1 : 1;
  if (at_p >= 0 || at_q >= 0) {
    if (at_p >= 0 && at_q >= 0) return -1;  // the disc has the segment for a chord
    return end_sign(v, at_p >= 0 ? at_p : at_q, query);
  }
  if (v.radius == 0) return 1;  // a corner at another point
  // The distance from the line: the center errs by position_error; the difference from a (1), a component of
  // u (3), a product (1) and the difference of both (1) by 6 roundings of |dx| + |dy| at most, and 1 to
  // spare.
  const SegmentSite& s = query.segment;
  const double dx = v.x - s.a.x, dy = v.y - s.a.y;
  const double clearance = std::abs(s.ux * dy - s.uy * dx) - v.radius;
  const double error = static_cast<double>(v.position_error) + static_cast<double>(v.radius_error) +
                       7 * unit_roundoff * (std::abs(dx) + std::abs(dy));
  if (clearance > error) return 1;
  if (clearance < -error) {
    // The line enters the disc, along a chord that holds neither end: half of the chord is longer than the
    // error, and so is the distance of the foot from either end.
    const double along = s.ux * dx + s.uy * dy;
    return along > 0 && along < s.length ? -1 : 1;
  }
  return sign_beyond_filter(v, query);
}

// At a corner, a vertex of radius 0 between a point and two of its own segments X, Y: the new segment is in
// conflict if it leaves within the sector from X to Y, which is less than 180 degrees.
int InsertionPredicates::corner_sign(const VoronoiRecord& v, int i, const SegmentQuery& query) const {
  const SiteIndex end = v.sites[static_cast<std::size_t>(i)];
  const LatticeVector d = sites_.direction_from(end, query.site);
  const LatticeVector x = sites_.direction_from(end, v.sites[static_cast<std::size_t>(discs::following(i))]);
  const LatticeVector y = sites_.direction_from(end, v.sites[static_cast<std::size_t>(discs::preceding(i))]);
  return cross(x, d) > 0 && cross(d, y) > 0 ? -1 : 0;
}

// The disc touches one end of the segment, site i: it is in conflict if (c - end) . direction > 0.
int InsertionPredicates::end_sign(const VoronoiRecord& v, int i, const SegmentQuery& query) {
  if (v.radius == 0) return corner_sign(v, i, query);
  const SiteIndex end = v.sites[static_cast<std::size_t>(i)];
  for (const int k : {discs::following(i), discs::preceding(i)}) {
    const SiteIndex own = v.sites[static_cast<std::size_t>(k)];
    if (!sites_.is_end(own, end)) continue;
    // The center lies on the normal of another segment of the same end.
    const std::int64_t turn = cross(sites_.segment(own).direction(), sites_.direction_from(end, query.site));
    const int side = v.is_left(k) ? 1 : -1;
    return turn == 0 ? 0 : (turn > 0) == (side > 0) ? -1 : 1;
  }
  const SegmentSite& s = query.segment;
  const LatticePoint& p = sites_.point(end);
  const double dx = v.x - p.x, dy = v.y - p.y;
  const double along = end == query.p ? s.ux * dx + s.uy * dy : -(s.ux * dx + s.uy * dy);
  const double error =
      static_cast<double>(v.position_error) + 7 * unit_roundoff * (std::abs(dx) + std::abs(dy));
  if (std::abs(along) > error) return along > 0 ? -1 : 0;
  if (const std::optional<int> forward = discs::sign_along_from_end(sites_, v, end, query.site)) {
    ++counts_.integer;
    return *forward > 0 ? -1 : 0;
  }
  return sign_beyond_filter(v, query);
}

int InsertionPredicates::sign_in_double_double(const VoronoiRecord& v, const SegmentQuery& query) const {
  const auto disc = discs::tangent_disc<DoubleDouble>(sites_, v.sites, v.left);
  if (!disc.known_within(1)) return undecided;
  const int at_p = v.find(query.p), at_q = v.find(query.q);
  if (at_p < 0 && at_q < 0) return clearance_sign(disc, query.segment);
  const SiteIndex end = at_p >= 0 ? query.p : query.q;
  const Offset offset =
      offset_of(disc, sites_.point(end), sites_.direction_from(end, query.site), query.segment.length);
  const int forward = sign_beyond(offset.along, offset.error);
  return forward == undecided ? undecided : forward > 0 ? -1 : 0;
}

// Whether the line of a segment that nearly touches the disc of three segments does touch it.
bool InsertionPredicates::is_touched_as_fourth(const VoronoiRecord& v, const SegmentQuery& query) const {
  std::array<kernel::LatticeSite, 4> lines;
  for (int i = 0; i < 3; ++i) {
    const SiteIndex site = v.sites[static_cast<std::size_t>(i)];
    if (!sites_.is_segment(site)) return false;
    lines[static_cast<std::size_t>(i)] = sites_.turned(site, v.is_left(i));
  }
  const SegmentSite& s = query.segment;
  lines[3] = sites_.turned(query.site, s.ux * (v.y - s.a.y) > s.uy * (v.x - s.a.x));
  return discs::is_one_circle(lines);
}

int InsertionPredicates::sign_beyond_filter(const VoronoiRecord& v, const SegmentQuery& query) {
  if (const std::optional<discs::DyadicDisc> disc = dyadic_disc(sites_, v)) {
    const int sign = disc->sign(query.segment);
    if (sign != undecided) {
      ++counts_.integer;
      return sign;
    }
  }
  const int sign = sign_in_double_double(v, query);
  if (sign != undecided) {
    ++counts_.double_double;
    return sign;
  }
  if (is_touched_as_fourth(v, query)) {
    ++counts_.integer;
    return 0;
  }
  ++counts_.exact;
  return discs::exact_clearance_sign(sites_.triple(v.sites), sites_.lattice_site(query.site));
}

// Where the edge passes from u to w, `point` being one of its sites: the shadow of the point is the ray from
// it straight away from the segment. On it no disc of the diagram through the point reaches the segment. If
// an edge whose ends are in conflict has points that are not, the shadow of one of its sites crosses it:
// along an edge the clearance d(segment) - r has one maximum between two slopes, and there the way from the
// point to the center is perpendicular to the segment; with a line for the other site there is none but on
// its shadow.
bool InsertionPredicates::survives(const VoronoiRecord& u, int i, const VoronoiRecord& w,
                                   const SegmentQuery& query) {
  const auto [right, left] = discs::sites_of_edge(u, i);
  if (right == sites_.infinite() || left == sites_.infinite()) return true;
  return (sites_.is_point(left) && has_shadow_on(u, i, w, true, query)) ||
         (sites_.is_point(right) && has_shadow_on(u, i, w, false, query));
}

// Whether the shadow of a point crosses edge i of u, between the point and another site. Seen from the point
// the edge turns counter-clockwise, from u to w or from w to u.
bool InsertionPredicates::has_shadow_on(const VoronoiRecord& u, int i, const VoronoiRecord& w, bool of_left,
                                        const SegmentQuery& query) {
  const auto [right, left] = discs::sites_of_edge(u, i);
  const SiteIndex point = of_left ? left : right, other = of_left ? right : left;
  const bool at_end = point == query.p || point == query.q;
  if (sites_.is_end(other, point)) {
    // The edge is on a line through the point, which is in its own shadow; at an end all behind it is.
    return !at_end && u.is_left(u.find(other)) != w.is_left(w.find(other));
  }
  if (at_end && sites_.is_point(other)) return false;
  const Arc arc{of_left ? u : w, of_left ? w : u, point, other};
  const int crossed = sites_.is_point(other) ? shadow_on_line(arc, query)
                      : at_end               ? end_shadow_on_parabola(arc, query)
                                             : shadow_on_parabola(arc, query);
  if (crossed != undecided) return crossed > 0;
  ++counts_.exact;
  return discs::exact_edge_clearance_sign(sites_.lattice_site(left), sites_.lattice_site(right),
                                          sites_.triple(u.sites), sites_.triple(w.sites),
                                          sites_.lattice_site(query.site)) > 0;
}

// The bisector of two points, seen from one of them over less than 180 degrees: along the segment, it goes
// from before the point to beyond it, or the other way where the point lies on the right of the segment. A
// vertex straight between point and segment is not near the shadow.
int InsertionPredicates::shadow_on_line(const Arc& arc, const SegmentQuery& query) const {
  const SegmentSite& s = query.segment;
  const LatticePoint& point = sites_.point(arc.point);
  const std::int64_t side = cross(s.direction(), point - s.a);
  if (side == 0) return -1;  // its shadow begins beyond an end of the segment, where nothing is in conflict
  const double turn = side > 0 ? -1 : 1;
  const Sighting from(arc.from, point, turn * s.ux, turn * s.uy);
  const Sighting to(arc.to, point, turn * s.ux, turn * s.uy);
  const int crossed = crosses(beyond(from.along, 0, from.error), beyond(to.along, 0, to.error));
  if (crossed != undecided) return crossed;
  const auto is_below = [](const Sighting& v) { return std::abs(v.along) <= v.error && v.across > v.error; };
  return is_below(from) || is_below(to) ? -1 : undecided;
}

// A parabola with the line of another segment for its directrix. In the frame of the directrix, with the
// point at (0, h), the shadow leaves in direction (b, c) and meets the parabola at y = h b / (1 - c).
int InsertionPredicates::shadow_on_parabola(const Arc& arc, const SegmentQuery& query) const {
  const SegmentSite& s = query.segment;
  const SegmentSite& base = sites_.segment(arc.other);
  const LatticePoint& point = sites_.point(arc.point);
  const std::int64_t side = cross(s.direction(), point - s.a);
  if (side == 0) return -1;
  const double turn = arc.from.is_left(arc.from.find(arc.other)) ? 1 : -1;
  const LatticeVector d = s.direction(), e = base.direction();
  const double shadow = side > 0 ? 1 : -1;
  // (b, c) times the product of both lengths
  const double ll = s.length * base.length;
  const double b = turn * shadow * static_cast<double>(cross(d, e));
  const double c = turn * shadow * static_cast<double>(dot(d, e));
  if (b == 0 && c > 0) return -1;  // away from the directrix, along the axis
  const double h = std::abs(static_cast<double>(cross(e, point - base.a))) / base.length;
  const double y = c > 0 ? h * (ll + c) / b : h * b / (ll - c);
  const double y_error = 16 * unit_roundoff * std::abs(y);  // 4 for h, 5 for ll +- c, 1 for b, 2 operations
  const Sighting from(arc.from, point, turn * base.ux, turn * base.uy);
  const Sighting to(arc.to, point, turn * base.ux, turn * base.uy);
  return crosses(beyond(from.along, y, from.error + y_error), beyond(to.along, y, to.error + y_error));
}

// The same at an end of the new segment, where the half plane behind the end takes the place of the ray. The
// line between both half planes goes through the focus: if the segment leaves away from the directrix, the
// part of the parabola behind it lies around the vertex of the parabola, where no vertex can be in conflict.
int InsertionPredicates::end_shadow_on_parabola(const Arc& arc, const SegmentQuery& query) const {
  const SegmentSite& base = sites_.segment(arc.other);
  const LatticePoint& point = sites_.point(arc.point);
  const bool is_left = arc.from.is_left(arc.from.find(arc.other));
  const std::int64_t away = cross(base.direction(), sites_.direction_from(arc.point, query.site));
  if (is_left ? away <= 0 : away >= 0) return -1;
  const double turn = is_left ? 1 : -1;
  const Sighting from(arc.from, point, turn * base.ux, turn * base.uy);
  const Sighting to(arc.to, point, turn * base.ux, turn * base.uy);
  return crosses(beyond(from.along, 0, from.error), beyond(to.along, 0, to.error));
}

}  // namespace vorotool::core::segment_voronoi::build
