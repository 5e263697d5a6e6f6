// Exact signs: known ones, those of other predicates, and the same after the plane is turned or mirrored.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "check.hpp"
#include "core/kernel/predicates.hpp"
#include "core/numbers/double_double.hpp"
#include "core/segment_voronoi/discs/exact_signs.hpp"
#include "core/segment_voronoi/discs/ties.hpp"
#include "discs/configurations.hpp"

using namespace vorotool::core::segment_voronoi::discs;
using namespace vorotool::tests;
using vorotool::core::kernel::LatticePoint;
using vorotool::core::kernel::LatticeSite;
using vorotool::core::kernel::LatticeVector;
using vorotool::core::kernel::left_of;
using vorotool::core::kernel::Point;
using vorotool::core::numbers::DoubleDouble;
using vorotool::core::numbers::int128;

namespace {

using Triple = std::array<LatticeSite, 3>;

LatticeSite at(const LatticePoint& p) { return {p, p}; }
LatticeSite at(std::int32_t x, std::int32_t y) { return at({x, y}); }
LatticePoint turned(const LatticePoint& p) { return {-p.y, p.x}; }
LatticeSite turned(const LatticeSite& s) { return {turned(s.a), turned(s.b)}; }
LatticeSite mirrored(const LatticeSite& s) { return {{s.a.y, s.a.x}, {s.b.y, s.b.x}}; }
Point real(const LatticePoint& p) { return {static_cast<double>(p.x), static_cast<double>(p.y)}; }

bool has_no_disc(const Triple& sites) { return !find_exact_disc(sites); }

// The distance of a closed site from a place.
template <class Real>
Real distance(const LatticeSite& site, const Real& x, const Real& y) {
  const LatticeVector u = site.b - site.a;
  const Real ux(static_cast<double>(u.x)), uy(static_cast<double>(u.y));
  const auto from = [&](const LatticePoint& p) {
    return std::pair{x - Real(static_cast<double>(p.x)), y - Real(static_cast<double>(p.y))};
  };
  const auto [ax, ay] = from(site.a);
  const auto [bx, by] = from(site.b);
  using std::abs;
  using std::sqrt;
  if (ax * ux + ay * uy < Real(0.0)) return sqrt(ax * ax + ay * ay);
  if (site.is_point() || bx * ux + by * uy > Real(0.0)) return sqrt(bx * bx + by * by);
  return abs(ax * uy - ay * ux) / sqrt(ux * ux + uy * uy);
}

// A segment that nearly touches a disc, as well as the lattice has it.
LatticeSite nearly_tangent(Random& random, const RoundedDisc& disc) {
  const double angle = static_cast<double>(random.whole(0, 6283)) / 1000, nx = std::cos(angle),
               ny = std::sin(angle);
  const auto end = [&](double along) {
    const auto whole = [](double value) {
      return static_cast<std::int32_t>(std::clamp(std::round(value), -0x1p30 + 1, 0x1p30 - 1));
    };
    return LatticePoint{whole(disc.x + disc.radius * nx - along * ny),
                        whole(disc.y + disc.radius * ny + along * nx)};
  };
  return {end(disc.radius * static_cast<double>(random.whole(0, 3))), end(-disc.radius)};
}

// Places along the edge of two sites from one disc to another: a line, or a parabola where a point is beside a
// segment that does not end there.
std::vector<Point> places_along(const LatticeSite& left, const LatticeSite& right, const RoundedDisc& from,
                                const RoundedDisc& to) {
  constexpr int count = 4000;
  const LatticeSite &focus = left.is_point() ? left : right, &base = left.is_point() ? right : left;
  const bool is_line = left.is_point() == right.is_point() || focus.a == base.a || focus.a == base.b;
  const LatticeVector u = base.b - base.a;
  const double length = std::sqrt(static_cast<double>(norm2(u)));
  const Point along{static_cast<double>(u.x) / length, static_cast<double>(u.y) / length};
  std::vector<Point> places;
  for (int k = 0; k <= count; ++k) {
    const double t = static_cast<double>(k) / count;
    const Point p{from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)};
    const Point way{p.x - focus.a.x, p.y - focus.a.y};
    const double foot = way.x * along.x + way.y * along.y;  // beside that of the focus
    const double height = static_cast<double>(cross(u, focus.a - base.a)) / length;
    const double up = (foot * foot / height - height) / 2;  // of the parabola above the focus
    places.push_back(is_line ? p
                             : Point{focus.a.x + foot * along.x - up * along.y,
                                     focus.a.y + foot * along.y + up * along.x});
  }
  return places;
}

}  // namespace

TEST(clearances_of_points_are_those_of_incircle) {
  Random random(1);
  int ties = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::int64_t most = i % 2 == 0 ? 4 : (1 << 30) - 1;
    const LatticePoint a = drawn_point(random, most), b = drawn_point(random, most),
                       c = drawn_point(random, most), d = drawn_point(random, most);
    if (orient2d(real(a), real(b), real(c)) <= 0) {
      CHECK(!find_exact_disc(Triple{at(a), at(b), at(c)}));
      continue;
    }
    const int sign = exact_clearance_sign(Triple{at(a), at(b), at(c)}, at(d));
    equal(sign, -incircle(real(a), real(b), real(c), real(d)));
    ties += sign == 0;
  }
  CHECK(ties > 20);
}

TEST(signs_are_those_of_certified_discs) {
  std::uint64_t seed = 6;
  int decided = 0, ties = 0;
  for (const std::int64_t most : {3, 20, 1 << 14, (1 << 30) - 1}) {
    Random random(seed);
    for (const Configuration& c : configurations(seed++, most, 100)) {
      const auto disc = c.certified();
      if (!disc) continue;
      for (int i = 0; i < 40; ++i) {
        const LatticePoint p = drawn_point(random, most);
        const LatticeSite query = i % 4 == 0   ? at(p)
                                  : i % 2 == 0 ? LatticeSite{p, drawn_point(random, most)}
                                               : nearly_tangent(random, rounded(c.disc));
        const DoubleDouble clearance = distance(query, disc->x, disc->y) - disc->radius;
        const double size = std::abs(disc->x.head) + std::abs(disc->y.head) + disc->radius.head + 0x1p31;
        const double error = 2 * disc->error + 0x1p-90 * size;
        const int sign = exact_clearance_sign(c.lattice_sites, query);
        if (abs(clearance).head > error) {
          equal(sign, clearance.head > 0 ? 1 : -1);
          ++decided;
        } else if (most <= 20) {  // none is that small but 0
          equal(sign, 0);
          ++ties;
        }
      }
    }
  }
  CHECK(decided > 10000);
  CHECK(ties > 100);
}

TEST(signs_stay_when_the_plane_is_turned_or_mirrored) {
  std::uint64_t seed = 2;
  for (const std::int64_t most : {3, 50, (1 << 30) - 1}) {
    Random random(seed);
    for (const Configuration& c : configurations(seed++, most, 60)) {
      const auto& [p, q, r] = c.lattice_sites;
      for (const LatticeSite& own : c.lattice_sites) equal(clearance_sign(c.disc, own), 0);
      for (int i = 0; i < 5; ++i) {
        const LatticeSite query{drawn_point(random, most), drawn_point(random, most)};
        const int sign = exact_clearance_sign(Triple{p, q, r}, query);
        equal(exact_clearance_sign(Triple{q, r, p}, {query.b, query.a}), sign);
        equal(exact_clearance_sign(Triple{turned(p), turned(q), turned(r)}, turned(query)), sign);
        equal(exact_clearance_sign(Triple{mirrored(r), mirrored(q), mirrored(p)}, mirrored(query)), sign);
      }
    }
  }
}

TEST(one_disc_of_several_triples) {
  const LatticeSite a = at(5, 0), b = at(0, 5), c = at(-3, 4), d = at(0, -5), tangent{{-5, -5}, {-5, 7}};
  CHECK(exact_same_disc(Triple{a, b, c}, Triple{b, c, d}));
  CHECK(exact_same_disc(Triple{a, b, tangent}, Triple{c, tangent, d}));
  CHECK(!exact_same_disc(Triple{a, b, c}, Triple{b, at(-3, 5), d}));
  bool is_refused = false;
  try {
    exact_clearance_sign(Triple{a, c, b}, d);
  } catch (const NoDisc&) {
    is_refused = true;
  }
  CHECK(is_refused);
}

TEST(centers_are_ordered_along_directions) {
  std::uint64_t seed = 3;
  for (const std::int64_t most : {4, 1 << 20}) {
    const std::vector<Configuration> drawn = configurations(seed++, most, 40);
    for (std::size_t i = 0; i + 1 < drawn.size(); ++i) {
      const ExactDisc &first = drawn[i].disc, &second = drawn[i + 1].disc;
      const RoundedDisc p = rounded(first), q = rounded(second);
      for (const LatticeVector& way : {LatticeVector{1, 0}, LatticeVector{-2, 3}}) {
        const int sign = compare_along(first, second, way);
        equal(compare_along(second, first, way), -sign);
        equal(compare_along(first, first, way), 0);
        const double x = static_cast<double>(way.x), y = static_cast<double>(way.y);
        const double apart = (p.x - q.x) * x + (p.y - q.y) * y;
        const double error = 0x1p-48 * (std::abs(p.x) + std::abs(q.x) + std::abs(p.y) + std::abs(q.y));
        if (std::abs(apart) > error) equal(sign, apart > 0 ? 1 : -1);
      }
    }
  }
}

// The edge of p and q runs along the first axis; a disc around (x, 0) has the radius sqrt(x^2 + 4).
TEST(the_middle_of_an_edge_survives_where_the_query_is_far) {
  const LatticeSite p = at(0, -2), q = at(0, 2);
  const Triple at_minus_3{q, at(-6, 2), p}, at_3{at(6, 2), q, p}, at_10{at(12, 10), q, p};
  const auto level = [](std::int32_t y) { return LatticeSite{{-100, y}, {100, y}}; };
  equal(exact_edge_clearance_sign(p, q, at_3, at_minus_3, level(3)), 1);
  equal(exact_edge_clearance_sign(q, p, at_minus_3, at_3, level(-3)), 1);
  equal(exact_edge_clearance_sign(p, q, at_10, at_3, level(3)), -1);              // not between the discs
  equal(exact_edge_clearance_sign(p, q, at_3, at_minus_3, level(0)), -1);         // between the points
  equal(exact_edge_clearance_sign(p, q, at_3, at_minus_3, {q.a, {100, 3}}), -1);  // from one of the points
  const LatticeSite across{{8, -100}, {8, 100}};
  equal(exact_edge_clearance_sign(p, q, at_10, at_3, across), -1);  // the clearance only grows along the edge
}

TEST(the_middle_of_an_edge_survives_where_a_disc_along_it_is_clear) {
  const auto enters = [](const LatticeSite& query, const ExactDisc& disc) {
    return clearance_sign(disc, query) < 0 && clearance_sign(disc, at(query.a)) >= 0 &&
           clearance_sign(disc, at(query.b)) >= 0;
  };
  std::uint64_t seed = 7;
  std::array<int, 2> seen{};
  for (const std::int64_t most : {4, 8, 1000, 1 << 29}) {
    const double rounding = 0x1p-30 * static_cast<double>(most);
    for (const Configuration& c : configurations(seed++, most, 1500)) {
      for (SiteIndex s = 6; s < 9; ++s) {
        const LatticeSite query = c.sites.lattice_site(s);
        if (std::ranges::count(c.triple, s) > 0 || !enters(query, c.disc)) continue;
        for (int k = 0; k < 27; ++k) {
          const auto other = static_cast<SiteIndex>(k / 3);
          const SiteIndex right = c.triple[static_cast<std::size_t>(following(k % 3))],
                          left = c.triple[static_cast<std::size_t>(preceding(k % 3))];
          if (other == s || c.sites.is_end(s, left) || c.sites.is_end(s, right)) continue;
          const auto w = configuration_of(c.sites, {right, other, left});
          if (!w || !enters(query, w->disc)) continue;
          const LatticeSite p = c.sites.lattice_site(left), q = c.sites.lattice_site(right);
          const std::vector<Point> places = places_along(p, q, rounded(c.disc), rounded(w->disc));
          double largest = -HUGE_VAL, step = 0;
          bool is_edge = true;
          for (std::size_t j = 1; j + 1 < places.size(); ++j) {
            const auto& [x, y] = places[j];
            const double radius = distance(p, x, y);
            is_edge = is_edge && std::abs(radius - distance(q, x, y)) < rounding;
            largest = std::max(largest, distance(query, x, y) - radius);
            step = std::max(step, std::hypot(x - places[j - 1].x, y - places[j - 1].y));
          }
          if (!is_edge || std::abs(largest) < 2 * step + rounding) continue;
          equal(exact_edge_clearance_sign(p, q, c.lattice_sites, w->lattice_sites, query),
                largest > 0 ? 1 : -1);
          ++seen[largest > 0 ? 1 : 0];
        }
      }
    }
  }
  CHECK(seen[0] > 10);
  CHECK(seen[1] > 10);
}

TEST(discs_at_corners_are_points) {
  const LatticeSite corner = at(0, 0), x_axis{{0, 0}, {5, 0}}, y_axis{{0, 7}, {0, 0}}, up{{0, 0}, {-3, 3}};
  for (const Triple& sites :
       {Triple{corner, x_axis, y_axis}, {x_axis, corner, y_axis}, {up, x_axis, y_axis}}) {
    const RoundedDisc disc = exact_disc_rounded(sites);
    CHECK(disc.x == 0 && disc.y == 0 && disc.radius == 0);
    equal(exact_clearance_sign(sites, at(0, 1)), 1);
    equal(exact_clearance_sign(sites, corner), 0);
    equal(exact_clearance_sign(sites, {{-2, -2}, {0, 0}}), 0);
    equal(exact_clearance_sign(sites, {{0, -1}, {1, -1}}), 1);
  }
}

// The center is (0, h) with h^2 = 9 + (4 - h)^2.
TEST(collinear_segments_touch_at_their_common_end) {
  const LatticeSite left{{-9, 0}, {0, 0}}, right{{0, 0}, {5, 0}}, end = at(0, 0), above = at(3, 4);
  for (const Triple& sites : {Triple{left, right, above}, {left, end, above}, {end, right, above}}) {
    const RoundedDisc disc = exact_disc_rounded(sites);
    CHECK(disc.x == 0 && disc.y == 3.125 && disc.radius == 3.125);
    CHECK(has_no_disc({sites[1], sites[0], sites[2]}));
  }
  CHECK(has_no_disc({left, right, end}) && has_no_disc({left, end, right}));
}

TEST(discs_between_parallel_segments) {
  const LatticeSite bottom{{-9, 0}, {9, 0}}, top{{-9, 2}, {9, 2}}, between = at(4, 1);
  const RoundedDisc before = exact_disc_rounded(Triple{bottom, between, top}),
                    behind = exact_disc_rounded(Triple{top, between, bottom});
  CHECK(before.x == 3 && before.y == 1 && before.radius == 1);
  CHECK(behind.x == 5 && behind.y == 1 && behind.radius == 1);
  CHECK(has_no_disc({bottom, top, {{-9, 4}, {9, 4}}}));
}

// Lines that touch the circle of radius 65 around the origin, in the directions of two triangles.
TEST(four_segments_around_one_circle) {
  const std::array<LatticeVector, 6> normals{{{65, 0}, {52, 39}, {25, 60}, {-39, 52}, {-60, -25}, {16, -63}}};
  const auto tangent = [&](std::size_t i, std::int64_t from, std::int64_t to) {
    const LatticeVector n = normals[i], u = left_of(n);
    const auto place = [&](std::int64_t k) {
      return LatticePoint{static_cast<std::int32_t>(n.x + k * u.x), static_cast<std::int32_t>(n.y + k * u.y)};
    };
    return LatticeSite{place(from), place(to)};
  };
  for (std::size_t i = 0; i < normals.size(); ++i) {
    for (std::size_t j = 1; j + 2 < normals.size(); ++j) {
      std::array<LatticeSite, 4> segments;
      for (std::size_t k = 0; k < 4; ++k) segments[k] = tangent((i + (k < 1 ? 0 : j + k - 1)) % 6, -1, 2);
      CHECK(is_one_circle(segments));
      ++segments[3].a.x;
      ++segments[3].b.x;
      CHECK(!is_one_circle(segments));
    }
  }
  CHECK(!is_one_circle({tangent(0, -1, 0), tangent(1, -1, 1), tangent(0, 0, 1), tangent(3, -1, 1)}));
}

TEST(ties_at_an_end_are_exact_signs) {
  Random random(4);
  for (int i = 0; i < 3000; ++i) {
    const std::int64_t most = i % 2 == 0 ? 5 : 1 << 29;
    const LatticePoint p = drawn_point(random, most), along = drawn_point(random, most),
                       q = drawn_point(random, most), to = drawn_point(random, most);
    if (p == along || p == q || p == to || along == q || along == to || q == to) continue;
    const LatticeVector u = along - p, w = q - p, d = to - q;
    const std::int64_t height = cross(u, w);
    if (height == 0) continue;
    const SegmentSites sites({p, along, q, to}, Ends{{0, 1}, {2, 3}});
    VoronoiRecord v{};
    v.sites = height > 0 ? std::array<SiteIndex, 3>{0, 4, 2} : std::array<SiteIndex, 3>{4, 0, 2};
    v.left = height > 0 ? 2 : 0;
    const auto sign = sign_along_from_end(sites, v, 2, 5);
    CHECK(sign.has_value());
    const auto disc = find_exact_disc(sites.triple(v.sites));
    CHECK(disc.has_value());
    // the disc of radius 0 at q, as one of which the center is known
    const ExactDisc end{disc->tower, q, 0, 0, 1, 0};
    equal(*sign, compare_along(*disc, end, d));
  }
  const SegmentSites sites({{0, 0}, {4, 0}, {0, 2}}, Ends{{0, 1}});
  VoronoiRecord v{};
  v.sites = {0, 1, 2};
  CHECK(!sign_along_from_end(sites, v, 2, 3));
}

TEST(rounded_discs_of_known_places) {
  const RoundedDisc corner = exact_disc_rounded(Triple{at(0, 0), at(4, 0), at(0, 2)});
  equal(corner.x, 2.0);
  equal(corner.y, 1.0);
  CHECK(std::abs(corner.radius - std::sqrt(5.0)) <= 0x1p-51);
  const RoundedDisc square =
      exact_disc_rounded(Triple{LatticeSite{{0, 0}, {8, 0}}, {{8, 0}, {8, 8}}, {{8, 8}, {0, 8}}});
  equal(square.x, 4.0);
  equal(square.y, 4.0);
  equal(square.radius, 4.0);
}

TEST(segments_of_sites_have_the_directions_that_they_state) {
  Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const std::int64_t most = i % 2 == 0 ? 4 : (1 << 30) - 1;
    const LatticePoint a = drawn_point(random, most), b = drawn_point(random, most);
    if (a == b) continue;
    const SegmentSites sites({a, b}, Ends{{1, 0}});
    const SegmentSite& s = sites.segment(2);
    const LatticeVector u = a - b;
    const DoubleDouble length = sqrt(DoubleDouble(int128{norm2(u)}));
    CHECK(abs(DoubleDouble(s.length) - length).head <= 1.5 * 0x1p-53 * s.length);
    CHECK(abs(DoubleDouble(s.ux) * length - DoubleDouble(int128{u.x})).head <=
          3 * 0x1p-53 * std::abs(s.ux) * s.length);
    CHECK(abs(DoubleDouble(s.uy) * length - DoubleDouble(int128{u.y})).head <=
          3 * 0x1p-53 * std::abs(s.uy) * s.length);
    CHECK(sites.lattice_site(2) == (LatticeSite{b, a}) && sites.turned(2, false) == (LatticeSite{a, b}));
    equal(sites.direction_from(0, 2).x, -u.x);
    CHECK(sites.is_end(2, 0) && sites.is_end(2, 1) && !sites.is_end(0, 1) && sites.infinite() == 3);
  }
}
