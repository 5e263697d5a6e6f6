// The largest integers, after core/numbers/sqrt_tower.hpp and the sizes in exact_disc.cpp (x <= 2^226 from
// any lattice point, w <= 2^191, two roots a disc):
//  - clearance from a segment: (N c)^2 <= (2 2^31 2^226)^2 = 2^516, two roots, so 4 516 = 2 064 bits;
//  - two centers along a direction: 2^32 (x w' - x' w) <= 2^450, four roots, so 16 450 = 7 200 bits;
//  - along a parabola: M (left_of(N) v) <= 2^64 2^258, three roots, so 8 323 = 2 584 bits.
// A sum of two of a size is a bit longer. With one root, as where lengths are commensurable or points are
// among the sites, a clearance takes 2 516 = 1 032 bits: that has room in a BigInteger itself.
#include "core/segment_voronoi/discs/exact_signs.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/numbers/sign.hpp"
#include "core/segment_voronoi/discs/contact_order.hpp"

namespace vorotool::core::segment_voronoi::discs {

using kernel::cross;
using kernel::dot;
using kernel::LatticePoint;
using kernel::LatticeSite;
using kernel::LatticeVector;
using kernel::left_of;
using kernel::norm2;
using numbers::magnitude;
using numbers::RootNumber;
using numbers::square;

namespace {

ExactDisc disc_of(SiteTriple sites) {
  auto disc = find_exact_disc(sites);
  if (!disc) throw NoDisc();
  return std::move(*disc);
}

// The way from a lattice point to a disc's center, times w.
struct CenterSeen {
  RootNumber x, y;

  CenterSeen(const ExactDisc& disc, const LatticePoint& from)
      : x(disc.x + disc.w * RootNumber((disc.origin - from).x)),
        y(disc.y + disc.w * RootNumber((disc.origin - from).y)) {}
  RootNumber along(const LatticeVector& u) const { return x * RootNumber(u.x) + y * RootNumber(u.y); }
  RootNumber length2() const { return square(x) + square(y); }
};

int clearance_sign(const ExactDisc& disc, const LatticePoint& query) {
  return (CenterSeen(disc, query).length2() - disc.z).sign();
}

// The middle of an edge.
//
// Let g(c) = (distance of c from the query's line) - r(c), with the sign of the distance counted positive
// where the edge's point sites are. In every case below g is concave along the bisector or its largest value
// is at an end of the edge; call the place of its largest value the summit.
//  - Both ends of the edge have their feet inside the query and g < 0. If g < 0 between them, the foot never
//    leaves the query, as at the query's ends the clearance would be g and not negative: the answer is -1.
//  - If g > 0 somewhere, the clearance is at least g: the answer is 1. As g < 0 at both ends, that is so if
//    and only if g is positive at the summit and the summit lies between the ends.
// On the other side of the query's line no disc touches the line and a point beyond it: g < 0 there.

// Which of two ends of an edge a direction meets first is never asked: only whether a place is between them.
bool between(int first, int second) { return first * second < 0; }

// The bisector of p and q is a line; r^2 = |q - p|^2 / 4 + t^2 in the distance t from the middle of p and q,
// so r is convex and g concave. With E = left_of(q - p) and N the query's normal, g is largest at
// (p + q) / 2 + E (N E) / (2 |N x E|), where it is positive if and only if p and q are on one side of the
// query: two discs touch p, q and the line then, and none else.
int middle_of_points(const LatticePoint& p, const LatticePoint& q, const ExactDisc& first,
                     const ExactDisc& second, const LatticeSite& query) {
  const LatticeVector u = query.b - query.a, e = left_of(q - p);
  const int p_side = numbers::sign_of(cross(u, p - query.a)),
            q_side = numbers::sign_of(cross(u, q - query.a));
  if (p_side == 0 || p_side != q_side) return -1;
  const LatticeVector n = p_side > 0 ? left_of(u) : -left_of(u);
  const std::int64_t turn = cross(n, e) < 0 ? -cross(n, e) : cross(n, e);
  if (turn == 0) return -1;  // the query is parallel to p q: g only grows along the edge
  auto side = [&](const ExactDisc& disc) {
    const RootNumber along = CenterSeen(disc, p).along(e) + CenterSeen(disc, q).along(e);
    return (along * RootNumber(turn) - disc.w * RootNumber(norm2(e)) * RootNumber(dot(n, e))).sign();
  };
  return between(side(first), side(second)) ? 1 : -1;
}

// The parabola of p and a segment t: in the coordinate left_of(N1) v along t, v the way from p to the center,
// r is quadratic and g concave, as point_and_lines in exact_disc.cpp has it: with N1 and N2 the normals of t
// and the query towards p, and H2 the height of p over the query, g is largest at left_of(N1) v = H1 D / M,
// and g > 0 there if H1 H2 M > 0. M = 0: both lines have one direction, and g has no summit.
// H2 = 0: g is 0 at its summit, where the disc touches the query's line at p. If p is not the query's end,
// that is beyond its ends, and the clearance is positive.
int middle_of_parabola(const LatticePoint& p, const LatticeSite& segment, const ExactDisc& first,
                       const ExactDisc& second, const LatticeSite& query) {
  auto normal_towards_p = [&p](const LatticeSite& line) {
    const LatticeVector n = left_of(line.b - line.a);
    return dot(n, p - line.a) < 0 ? -n : n;
  };
  const LatticeVector n1 = normal_towards_p(segment), n2 = normal_towards_p(query);
  if (cross(n1, n2) == 0 && dot(n1, n2) > 0) return -1;
  const std::int64_t h1 = dot(n1, p - segment.a);
  auto side = [&](const ExactDisc& disc) {
    numbers::SqrtTower tower;
    const std::vector<RootNumber> lifted = tower.adjoin_all(*disc.tower);
    const RootNumber m =
        tower.adjoin_root(RootNumber(norm2(n1)) * RootNumber(norm2(n2))) - RootNumber(dot(n1, n2));
    const RootNumber along = tower.lift(CenterSeen(disc, p).along(left_of(n1)), lifted);
    return (m * along - RootNumber(h1) * RootNumber(cross(n1, n2)) * tower.lift(disc.w, lifted)).sign();
  };
  return between(side(first), side(second)) ? 1 : -1;
}

// p is the query's end: (p - c) u for the query's direction u from p is concave along the parabola if t is
// behind p, seen along u; it is positive at its summit then, which the disc that touches the query's line at
// p would have: left_of(N1) v = -H1 (left_of(N1) u) / (N1 u). Else it is largest at an end.
int middle_behind_end(const LatticePoint& p, const LatticeSite& segment, const ExactDisc& first,
                      const ExactDisc& second, const LatticeVector& u) {
  const LatticeVector raw = left_of(segment.b - segment.a);
  const LatticeVector n1 = dot(raw, p - segment.a) < 0 ? -raw : raw;
  if (dot(n1, u) <= 0) return -1;
  auto side = [&](const ExactDisc& disc) {
    const RootNumber along = CenterSeen(disc, p).along(left_of(n1));
    return (along * RootNumber(dot(n1, u)) +
            disc.w * RootNumber(dot(n1, p - segment.a)) * RootNumber(dot(left_of(n1), u)))
        .sign();
  };
  return between(side(first), side(second)) ? 1 : -1;
}

// The bisector of p and a segment from p is the line across it, on which r is the distance from p. On either
// side of p the clearance is convex: largest at an end, or at p, where it is positive.
int middle_across_end(const LatticePoint& p, const LatticeSite& segment, const ExactDisc& first,
                      const ExactDisc& second) {
  const LatticeVector across = left_of(segment.b - segment.a);
  auto side = [&](const ExactDisc& disc) { return CenterSeen(disc, p).along(across).sign(); };
  return between(side(first), side(second)) ? 1 : -1;
}

int middle_of_point_and_segment(const LatticePoint& p, const LatticeSite& segment, const ExactDisc& first,
                                const ExactDisc& second, const LatticeSite& query) {
  const bool own_end = query.is_end(p), own_segment = segment.is_end(p);
  if (own_end && own_segment) return -1;  // (p - c) u is linear: largest at an end
  if (own_segment) return middle_across_end(p, segment, first, second);
  if (!own_end) return middle_of_parabola(p, segment, first, second, query);
  const LatticeVector u = p == query.a ? query.b - query.a : query.a - query.b;
  return middle_behind_end(p, segment, first, second, u);
}

double quotient(const RootNumber& number, const numbers::RootMagnitude& divisor) {
  const int sign = number.sign();
  return sign == 0 ? 0 : sign * (magnitude(number) / divisor).rounded();
}

}  // namespace

int clearance_sign(const ExactDisc& disc, const LatticeSite& query) {
  const LatticeVector u = query.b - query.a;
  const CenterSeen center(disc, query.a);
  const RootNumber along = center.along(u);
  if (query.is_point() || along.sign() <= 0) return clearance_sign(disc, query.a);
  if ((along - disc.w * RootNumber(norm2(u))).sign() >= 0) return clearance_sign(disc, query.b);
  return (square(center.along(left_of(u))) - disc.z * RootNumber(norm2(u))).sign();
}

int side_of_center(const ExactDisc& disc, const LatticePoint& point, const LatticeVector& direction) {
  return CenterSeen(disc, point).along(direction).sign();
}

int compare_along(const ExactDisc& first, const ExactDisc& second, const LatticeVector& direction) {
  numbers::SqrtTower tower;
  const std::vector<RootNumber> lifted_first = tower.adjoin_all(*first.tower),
                                lifted_second = tower.adjoin_all(*second.tower);
  const RootNumber a = tower.lift(CenterSeen(first, first.origin).along(direction), lifted_first);
  const RootNumber b = tower.lift(CenterSeen(second, first.origin).along(direction), lifted_second);
  return (a * tower.lift(second.w, lifted_second) - b * tower.lift(first.w, lifted_first)).sign();
}

RoundedDisc rounded(const ExactDisc& disc) {
  const numbers::RootMagnitude w = magnitude(disc.w);
  const CenterSeen center(disc, {0, 0});
  const double radius = disc.z.sign() == 0 ? 0 : (numbers::square_root(magnitude(disc.z)) / w).rounded();
  return {quotient(center.x, w), quotient(center.y, w), radius};
}

int exact_clearance_sign(SiteTriple sites, const LatticeSite& query) {
  return clearance_sign(disc_of(sites), query);
}

// There is one disc that touches three sites in their order. So no number of one disc need meet one of the
// other: that with fewer segments has shorter ones.
bool exact_same_disc(SiteTriple first, SiteTriple second) {
  const auto segments_of = [](SiteTriple sites) {
    return std::ranges::count(sites, false, &LatticeSite::is_point);
  };
  if (segments_of(first) > segments_of(second)) std::swap(first, second);
  const ExactDisc disc = disc_of(first);
  const auto is_touched = [&](const LatticeSite& site) {
    return std::ranges::find(first, site) != first.end() || touches(disc, site);
  };
  return std::ranges::all_of(second, is_touched) && contacts_in_order(disc, second);
}

int exact_edge_clearance_sign(const LatticeSite& left, const LatticeSite& right, SiteTriple first,
                              SiteTriple second, const LatticeSite& query) {
  const ExactDisc a = disc_of(first), b = disc_of(second);
  if (left.is_point() && right.is_point()) {
    if (query.is_end(left.a) || query.is_end(right.a)) return -1;  // (p - c) u is linear: largest at an end
    return middle_of_points(left.a, right.a, a, b, query);
  }
  if (left.is_point()) return middle_of_point_and_segment(left.a, right, a, b, query);
  if (right.is_point()) return middle_of_point_and_segment(right.a, left, a, b, query);
  return -1;  // r is linear and the clearance convex: largest at an end
}

RoundedDisc exact_disc_rounded(SiteTriple sites) { return rounded(disc_of(sites)); }

}  // namespace vorotool::core::segment_voronoi::discs
