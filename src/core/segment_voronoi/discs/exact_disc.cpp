// Sizes, as core/numbers/sqrt_tower.hpp counts them: vectors are at most 2^31, so the dot and cross products
// T, H, G's factors, L^2 and D are at most 2^63. In each case |x|, |y| <= 2^225, w <= 2^191 (2^192 where the
// tower has no root), and the tower has at most two roots. Only the largest case of each quantity is derived,
// beside its formula.
#include "core/segment_voronoi/discs/exact_disc.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace vorotool::core::segment_voronoi::discs {

using kernel::cross;
using kernel::dot;
using kernel::LatticePoint;
using kernel::LatticeSite;
using kernel::LatticeVector;
using kernel::left_of;
using kernel::norm2;
using numbers::RootNumber;
using numbers::SqrtTower;
using numbers::square;

namespace {

using Found = std::optional<ExactDisc>;
using Tower = std::shared_ptr<SqrtTower>;

// A segment seen from one of its ends, or an oriented line.
struct Ray {
  LatticePoint origin;
  LatticeVector along;

  Ray reversed() const { return {origin, -along}; }
  // The length of `along` times the signed distance of p, positive to the left.
  std::int64_t height(const LatticePoint& p) const { return cross(along, p - origin); }
  LatticeVector normal() const { return left_of(along); }
};

Ray ray_of(const LatticeSite& segment) { return {segment.a, segment.b - segment.a}; }

// With p to its left; nothing if p is on the line.
std::optional<Ray> oriented_towards(const LatticeSite& segment, const LatticePoint& p) {
  const Ray ray = ray_of(segment);
  const std::int64_t height = ray.height(p);
  if (height == 0) return std::nullopt;
  return height > 0 ? ray : ray.reversed();
}

// The direction from its end p into the segment.
LatticeVector direction_from(const LatticePoint& p, const LatticeSite& segment) {
  return p == segment.a ? segment.b - segment.a : segment.a - segment.b;
}

std::optional<LatticePoint> common_end(const LatticeSite& s, const LatticeSite& t) {
  if (t.is_end(s.a)) return s.a;
  if (t.is_end(s.b)) return s.b;
  return std::nullopt;
}

bool on_one_line(const LatticeSite& s, const LatticeSite& t) {
  const Ray ray = ray_of(s);
  return ray.height(t.a) == 0 && ray.height(t.b) == 0;
}

ExactDisc point_disc(const LatticePoint& p) { return {std::make_shared<SqrtTower>(), p, 0, 0, 1, 0}; }

// Sites that touch at one place p: the center is p + t normal, t > 0.

// |p + t n - q| = t |n| where t = |q - p|^2 / (2 n (q - p)).
Found touching_at(const LatticePoint& p, const LatticeVector& normal, const LatticePoint& q) {
  const LatticeVector way = q - p;
  if (dot(normal, way) <= 0) return std::nullopt;
  const RootNumber t = RootNumber(norm2(way));
  return ExactDisc{std::make_shared<SqrtTower>(),
                   p,
                   t * RootNumber(normal.x),
                   t * RootNumber(normal.y),
                   RootNumber(2) * RootNumber(dot(normal, way)),
                   RootNumber(norm2(normal)) * square(t)};
}

// The disc is on p's side of the segment's line: height(p) + t N n = |N| |n| t for the line's normal N.
Found touching_at(const LatticePoint& p, const LatticeVector& normal, const LatticeSite& segment) {
  const auto ray = oriented_towards(segment, p);
  if (!ray) return std::nullopt;
  const LatticeVector other = ray->normal();
  if (cross(other, normal) == 0 && dot(other, normal) > 0) return std::nullopt;
  const auto tower = std::make_shared<SqrtTower>();
  const RootNumber lengths = tower->adjoin_root(RootNumber(norm2(normal)) * RootNumber(norm2(other)));
  const RootNumber height = RootNumber(ray->height(p));
  return ExactDisc{tower,
                   p,
                   height * RootNumber(normal.x),
                   height * RootNumber(normal.y),
                   lengths - RootNumber(dot(other, normal)),
                   RootNumber(norm2(normal)) * square(height)};
}

Found touching_at_either(const LatticePoint& p, const LatticeVector& normal, const LatticeSite& third) {
  return third.is_point() ? touching_at(p, normal, third.a) : touching_at(p, normal, third);
}

// A segment, its end p, then the third: the disc is to the right of p -> segment.
Found segment_before_its_end(const LatticeSite& segment, const LatticePoint& p, const LatticeSite& third) {
  return touching_at_either(p, -left_of(direction_from(p, segment)), third);
}

// The end p, its segment, then the third: the disc is to the left.
Found end_before_its_segment(const LatticePoint& p, const LatticeSite& segment, const LatticeSite& third) {
  return touching_at_either(p, left_of(direction_from(p, segment)), third);
}

// Three points.

// Cramer's rule for the two bisectors, seen from a.
Found circle(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
  const LatticeVector ab = b - a, ac = c - a;
  if (cross(ab, ac) <= 0) return std::nullopt;
  const RootNumber ab2 = RootNumber(norm2(ab)), ac2 = RootNumber(norm2(ac));
  const RootNumber x = ab2 * RootNumber(ac.y) - ac2 * RootNumber(ab.y),
                   y = ac2 * RootNumber(ab.x) - ab2 * RootNumber(ac.x);
  return ExactDisc{std::make_shared<SqrtTower>(), a, x, y, RootNumber(2) * RootNumber(cross(ab, ac)),
                   square(x) + square(y)};
}

// A segment and two points.

// In coordinates along the segment and across it, times its length L, from below p: p = (0, Hp), q = (Tq,
// Hq), center = (T, R) with T^2 + (R - Hp)^2 = R^2 and (T - Tq)^2 + (R - Hq)^2 = R^2. Without R:
//   (Hq - Hp) T^2 + 2 Hp Tq T - Hp (Tq^2 + Hq^2 - Hp Hq) = 0,
//   T = (-Hp Tq + S) / (Hq - Hp) with S^2 = Hp Hq G, G = Tq^2 + (Hq - Hp)^2 = L^2 |q - p|^2,
// and the foot (T, 0), p, q are counter-clockwise if Hp T - Tq Hp - T Hq = -S > 0: S is the negative root.
//   R = (T^2 + Hp^2) / (2 Hp) = ((Hp + Hq) G - 2 Tq S) / (2 (Hq - Hp)^2).
// Equal heights leave one circle, T = Tq / 2, in the order of the segment, p, q if q is to the left of p.
// Sizes: Hp Tq, S <= 2^126, R's numerator <= 2^191, x <= 2^31 (2 2^127 2^63 + 2^191 + 2 2^189) <= 2^224,
// w = 2 L^2 (Hq - Hp)^2 <= 2^190.
Found segment_and_points(const LatticeSite& segment, const LatticePoint& p, const LatticePoint& q) {
  if (segment.is_end(p) && segment.is_end(q)) return std::nullopt;
  if (segment.is_end(p)) return segment_before_its_end(segment, p, {q, q});
  if (segment.is_end(q)) return end_before_its_segment(q, segment, {p, p});
  const auto ray = oriented_towards(segment, p);
  if (!ray || ray->height(q) <= 0) return std::nullopt;
  const std::int64_t hp = ray->height(p), hq = ray->height(q), tq = dot(ray->along, q - p);
  const LatticeVector u = ray->along, n = ray->normal();
  const auto tower = std::make_shared<SqrtTower>();
  RootNumber t = 0, r = 0, divisor = 0;  // T = t / divisor, R = r / (2 divisor^2)
  if (hp == hq) {
    if (tq >= 0) return std::nullopt;
    // with divisor 2 Hp, so that R is a fraction: T = Tq Hp / (2 Hp), R = (Tq^2 + 4 Hp^2) Hp / (2 (2 Hp)^2)
    divisor = RootNumber(2) * RootNumber(hp);
    t = RootNumber(tq) * RootNumber(hp);
    r = (square(RootNumber(tq)) + square(divisor)) * RootNumber(hp);
  } else {
    divisor = RootNumber(hq - hp);
    const RootNumber g = square(RootNumber(tq)) + square(divisor);
    const RootNumber s = -tower->adjoin_root(RootNumber(hp) * RootNumber(hq) * g);
    t = s - RootNumber(hp) * RootNumber(tq);
    r = RootNumber(hp + hq) * g - RootNumber(2) * RootNumber(tq) * s;
  }
  const RootNumber along = RootNumber(2) * t * divisor,
                   across = r - RootNumber(2) * RootNumber(hp) * square(divisor);
  return ExactDisc{tower,
                   p,
                   along * RootNumber(u.x) + across * RootNumber(n.x),
                   along * RootNumber(u.y) + across * RootNumber(n.y),
                   RootNumber(2) * RootNumber(norm2(u)) * square(divisor),
                   RootNumber(norm2(u)) * square(r)};
}

// A point and two segments.

// Two collinear segments, s then t: the disc touches both at their common end, to the left of it -> t.
Found collinear_pair(const LatticeSite& s, const LatticeSite& t, const LatticeSite& third) {
  const auto end = common_end(s, t);
  if (!end) return std::nullopt;
  return end_before_its_segment(*end, t, third);
}

// With Ni the lines' normals towards p, Li their lengths, Hi > 0 the heights of p, and v the way from p to
// the center: Ni v + Hi = Li r and |v| = r. With K = L1 L2, M = K - N1 N2, D = N1 x N2, Q^2 = 2 H1 H2 M and
// sigma = 1 or -1
//   L1 r = ((L1^2 H2 + K H1) M + sigma D L1 Q) / M^2,   left_of(N1) v = (H1 D + sigma L1 Q) / M.
// (Put N2 v = (N1 N2 N1 v + D left_of(N1) v) / L1^2 in, and D^2 = M (K + N1 N2).) Where p is between parallel
// lines sigma = 1 is the disc to the left of p along the first line, which touches p, then the second, then
// the first; the order could only change where two contacts meet, that is at M = 0 or Hi = 0. So the order
// p, first, second has sigma = -1.
// Sizes: M <= 2^64, L1 Q <= 2^127, L1 r M^2 <= 2^192, the brackets of x <= 2^193 + 2^192, x <= 2^225,
// w = L1^2 M^2 <= 2^191.
Found point_and_lines(const LatticePoint& p, const Ray& first, const Ray& second) {
  const LatticeVector n1 = first.normal(), n2 = second.normal();
  const std::int64_t h1 = first.height(p), h2 = second.height(p), d = cross(n1, n2);
  if (d == 0 && dot(n1, n2) > 0) return std::nullopt;
  const auto tower = std::make_shared<SqrtTower>();
  const RootNumber l1 = RootNumber(norm2(n1));  // squared
  const RootNumber k = tower->adjoin_root(l1 * RootNumber(norm2(n2)));
  const RootNumber m = k - RootNumber(dot(n1, n2));
  const RootNumber q = -tower->adjoin_root(RootNumber(2) * RootNumber(h1) * RootNumber(h2) * l1 * m);
  const RootNumber r = (l1 * RootNumber(h2) + k * RootNumber(h1)) * m + RootNumber(d) * q;
  const RootNumber across = r - RootNumber(h1) * square(m), along = (RootNumber(h1) * RootNumber(d) + q) * m;
  const LatticeVector u = left_of(n1);
  return ExactDisc{tower,
                   p,
                   across * RootNumber(n1.x) + along * RootNumber(u.x),
                   across * RootNumber(n1.y) + along * RootNumber(u.y),
                   l1 * square(m),
                   l1 * square(r)};
}

Found point_and_segments(const LatticePoint& p, const LatticeSite& s, const LatticeSite& t) {
  if (s.is_end(p) && t.is_end(p)) {
    if (on_one_line(s, t)) return std::nullopt;
    return point_disc(p);
  }
  if (s.is_end(p)) return end_before_its_segment(p, s, t);
  if (t.is_end(p)) return segment_before_its_end(t, p, s);
  if (on_one_line(s, t)) return collinear_pair(s, t, {p, p});
  const auto first = oriented_towards(s, p), second = oriented_towards(t, p);
  if (!first || !second) return std::nullopt;
  return point_and_lines(p, *first, *second);
}

// Three segments.

using Lines = std::array<Ray, 3>;

// The disc to the left of all lines, which it touches in counter-clockwise order. With Hi the heights of the
// first line's origin over the lines, and v the way from there to the center: Ni v + Hi = Li r. By Cramer's
// rule, in sums over the cyclic orders i, j, k,
//   W r = sum Hi (Nj x Nk),  W v = -sum Li left_of(Hk Nj - Hj Nk),  W = sum Li (Nj x Nk).
// W is the orientation of the three contacts: positive exactly where at least two of the cross products are,
// since of three angles that sum to 360 degrees at least two are under 180. The numerator of r is an integer;
// the others are taken times L1, so that only L1 L2 and L1 L3 are roots.
// Sizes: H <= 2^63, L1 Li <= 2^63, x <= 3 2^63 2 2^63 2^31 < 2^160, w < 2^128.
Found disc_left_of(const Lines& lines) {
  std::array<LatticeVector, 3> n;
  std::array<std::int64_t, 3> h, turn;  // turn[i] = Nj x Nk
  for (std::size_t i = 0; i < 3; ++i) {
    n[i] = lines[i].normal();
    h[i] = lines[i].height(lines[0].origin);
  }
  for (std::size_t i = 0; i < 3; ++i) turn[i] = cross(n[(i + 1) % 3], n[(i + 2) % 3]);
  if ((turn[0] > 0) + (turn[1] > 0) + (turn[2] > 0) < 2) return std::nullopt;
  RootNumber r = 0;  // times W
  for (std::size_t i = 0; i < 3; ++i) r = r + RootNumber(h[i]) * RootNumber(turn[i]);
  if (r.sign() <= 0) return std::nullopt;
  const auto tower = std::make_shared<SqrtTower>();
  const RootNumber l1 = RootNumber(norm2(n[0]));  // squared
  const std::array<RootNumber, 3> l{l1, tower->adjoin_root(l1 * RootNumber(norm2(n[1]))),
                                    tower->adjoin_root(l1 * RootNumber(norm2(n[2])))};
  RootNumber x = 0, y = 0, w = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    x = x + l[i] * (RootNumber(h[k]) * RootNumber(n[j].y) - RootNumber(h[j]) * RootNumber(n[k].y));
    y = y + l[i] * (RootNumber(h[j]) * RootNumber(n[k].x) - RootNumber(h[k]) * RootNumber(n[j].x));
    w = w + l[i] * RootNumber(turn[i]);
  }
  return ExactDisc{tower, lines[0].origin, x, y, w, l1 * square(r)};
}

// Whether the disc can be on the left of line i, for all the other segments are there in part: a disc touches
// a segment that does not cross the line on the side where the segment is.
bool sides_agree(const Lines& lines, SiteTriple sites) {
  for (const Ray& line : lines) {
    for (const LatticeSite& site : sites) {
      const std::int64_t a = line.height(site.a), b = line.height(site.b);
      if (a <= 0 && b <= 0 && (a < 0 || b < 0)) return false;
    }
  }
  return true;
}

bool feet_on_segments(const ExactDisc& disc, SiteTriple sites) {
  return touches(disc, sites[0]) && touches(disc, sites[1]) && touches(disc, sites[2]);
}

// Which side of each line: eight cases. No two discs that touch the segments in the same order have their
// feet on them: the order of contact distinguishes the circle inscribed in the lines' triangle from the three
// others; and of these two touch, say, the lines a and b on either side of the corner of a and b, so that
// both segments would hold this corner inside and cross. Parallel lines leave two circles of opposite orders.
Found segments(SiteTriple sites) {
  std::vector<ExactDisc> candidates;
  for (unsigned sides = 0; sides < 8; ++sides) {
    Lines lines;
    for (std::size_t i = 0; i < 3; ++i) {
      const Ray ray = ray_of(sites[i]);
      lines[i] = (sides >> i & 1) != 0 ? ray.reversed() : ray;
    }
    if (!sides_agree(lines, sites)) continue;
    if (auto disc = disc_left_of(lines)) candidates.push_back(std::move(*disc));
  }
  if (candidates.size() == 1) return candidates.front();
  for (const ExactDisc& disc : candidates) {
    if (feet_on_segments(disc, sites)) return disc;
  }
  return std::nullopt;
}

Found three_segments(SiteTriple sites) {
  for (const LatticePoint& p : {sites[0].a, sites[0].b}) {
    if (sites[1].is_end(p) && sites[2].is_end(p)) return point_disc(p);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const LatticeSite &s = sites[i], &t = sites[(i + 1) % 3], &third = sites[(i + 2) % 3];
    if (on_one_line(s, t)) return collinear_pair(s, t, third);
  }
  return segments(sites);
}

}  // namespace

Found find_exact_disc(SiteTriple sites) {
  int points = 0;
  for (const LatticeSite& site : sites) points += site.is_point() ? 1 : 0;
  if (points == 3) return circle(sites[0].a, sites[1].a, sites[2].a);
  if (points == 0) return three_segments(sites);
  for (std::size_t i = 0; i < 3; ++i) {
    const LatticeSite &a = sites[i], &b = sites[(i + 1) % 3], &c = sites[(i + 2) % 3];
    if (points == 2 && !a.is_point()) return segment_and_points(a, b.a, c.a);
    if (points == 1 && a.is_point()) return point_and_segments(a.a, b, c);
  }
  return std::nullopt;
}

bool touches(const ExactDisc& disc, const LatticeSite& site) {
  const LatticeVector shift = disc.origin - site.a;  // the center seen from a, times w
  const RootNumber x = disc.x + disc.w * RootNumber(shift.x), y = disc.y + disc.w * RootNumber(shift.y);
  if (site.is_point()) return (square(x) + square(y) - disc.z).sign() == 0;
  const LatticeVector u = site.b - site.a, n = left_of(u);
  const RootNumber along = x * RootNumber(u.x) + y * RootNumber(u.y),
                   across = x * RootNumber(n.x) + y * RootNumber(n.y);
  return along.sign() >= 0 && (along - disc.w * RootNumber(norm2(u))).sign() <= 0 &&
         (square(across) - disc.z * RootNumber(norm2(u))).sign() == 0;
}

}  // namespace vorotool::core::segment_voronoi::discs
