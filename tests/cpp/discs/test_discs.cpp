// The levels of the disc that touches three sites: each is right within the bounds that it states.
#include <array>
#include <cmath>

#include "check.hpp"
#include "core/segment_voronoi/discs/certified_disc.hpp"
#include "core/segment_voronoi/discs/contact_order.hpp"
#include "core/segment_voronoi/discs/dyadic_disc.hpp"
#include "core/segment_voronoi/discs/exact_signs.hpp"
#include "core/segment_voronoi/discs/tangent_disc.hpp"
#include "discs/configurations.hpp"

using namespace vorotool::core::segment_voronoi::discs;
using namespace vorotool::tests;
using vorotool::core::kernel::LatticeSite;
using vorotool::core::numbers::DoubleDouble;
using vorotool::core::numbers::undecided;

namespace {

// Grids where ties abound, and the lattice as a whole.
constexpr std::array<std::int64_t, 4> sizes{3, 20, 1 << 14, (1 << 30) - 1};

double head(double value) { return value; }
double head(const DoubleDouble& value) { return value.head; }

template <class Real>
DoubleDouble absolute(std::int32_t anchor, const Real& offset) {
  return DoubleDouble(static_cast<double>(anchor)) + DoubleDouble(offset);
}

bool is_within(const DoubleDouble& a, double b, double error) {
  const double rounding = 0x1p-52 * std::abs(b);
  return abs(a - DoubleDouble(b)).head <= error + rounding;
}

template <class Real>
void tangent_discs_are_within_their_bounds(std::uint64_t seed, double part) {
  std::size_t known = 0, all = 0;
  for (const std::int64_t most : sizes) {
    for (const Configuration& c : configurations(seed++, most, 250)) {
      const TangentDisc<Real> disc = tangent_disc<Real>(c.sites, c.triple, c.left);
      ++all;
      if (!disc.known_within(part)) continue;
      ++known;
      const RoundedDisc exact = rounded(c.disc);
      CHECK(is_within(absolute(disc.anchor.x, disc.x), exact.x, disc.position_error));
      CHECK(is_within(absolute(disc.anchor.y, disc.y), exact.y, disc.position_error));
      CHECK(is_within(DoubleDouble(disc.radius), exact.radius, disc.radius_error));
      const auto [p, q, r] = c.triple;
      const auto turned = static_cast<std::uint8_t>(c.left >> 1 | (c.left & 1) << 2);
      const TangentDisc<Real> same = tangent_disc<Real>(c.sites, {q, r, p}, turned);
      CHECK(head(same.x) == head(disc.x) && head(same.y) == head(disc.y) &&
            head(same.radius) == head(disc.radius));
    }
  }
  CHECK(known * 10 >= all * 9);
}

}  // namespace

TEST(tangent_discs_of_doubles_are_within_their_bounds) {
  tangent_discs_are_within_their_bounds<double>(1, 0x1p-20);
}

TEST(tangent_discs_of_106_bits_are_within_their_bounds) {
  tangent_discs_are_within_their_bounds<DoubleDouble>(11, 0x1p-60);
}

TEST(certified_discs_are_the_tangent_ones) {
  std::uint64_t seed = 21;
  std::size_t certified = 0;
  for (const std::int64_t most : sizes) {
    for (const Configuration& c : configurations(seed++, most, 250)) {
      const RoundedDisc exact = rounded(c.disc);
      const auto disc = c.certified();
      if (!disc) continue;
      ++certified;
      CHECK(is_within(disc->x, exact.x, disc->error));
      CHECK(is_within(disc->y, exact.y, disc->error));
      CHECK(is_within(disc->radius, exact.radius, disc->error));
      CHECK(disc->error <= 0x1p-56 * exact.radius);
      const TangentDisc<DoubleDouble> closed = tangent_disc<DoubleDouble>(c.sites, c.triple, c.left);
      const double error =
          disc->error + closed.position_error + 0x1p-100 * (std::abs(exact.x) + std::abs(exact.y));
      CHECK(abs(absolute(closed.anchor.x, closed.x) - disc->x).head <= error);
      CHECK(abs(absolute(closed.anchor.y, closed.y) - disc->y).head <= error);
    }
  }
  CHECK(certified >= 800);
}

TEST(what_no_disc_is_near_is_not_certified) {
  using enum DiscCondition::Kind;
  const std::array<DiscCondition, 3> circle{
      {{point, {1, 0}, {1, 0}}, {point, {0, 1}, {0, 1}}, {point, {-1, 0}, {}}}};
  const auto disc = certify_disc(circle, 0.01, -0.02, 1);
  CHECK(disc && std::abs(disc->x.head) <= disc->error && std::abs(disc->radius.head - 1) <= disc->error);
  CHECK(!certify_disc(circle, 0, 0, -1));
  CHECK(!certify_disc(circle, 0x1p40, 0x1p40, 1));
  const std::array<DiscCondition, 3> line{{{point, {1, 0}, {}}, {point, {2, 0}, {}}, {point, {3, 0}, {}}}};
  CHECK(!certify_disc(line, 0, 0, 1));
}

TEST(dyadic_discs_are_the_exact_ones) {
  std::uint64_t seed = 31;
  std::size_t dyadic = 0;
  for (const std::int64_t most : sizes) {
    Random random(seed);
    for (const Configuration& c : configurations(seed++, most, 250)) {
      const auto disc = dyadic_disc(c.sites, c.record());
      if (!disc) continue;
      ++dyadic;
      const RoundedDisc exact = rounded(c.disc);
      equal(disc->x(), exact.x);
      equal(disc->y(), exact.y);
      CHECK(is_within(DoubleDouble(disc->radius()), exact.radius, 0x1p-52 * exact.radius));
      for (int i = 0; i < 20; ++i) {
        const auto a = drawn_point(random, most), b = drawn_point(random, most);
        if (a == b || clearance_sign(c.disc, {a, a}) < 0 || clearance_sign(c.disc, {b, b}) < 0) continue;
        const SegmentSites query({a, b}, Ends{{0, 1}});
        const int sign = disc->sign(query.segment(2)), right = clearance_sign(c.disc, {a, b});
        const bool ends_touch = touches(c.disc, {a, a}) || touches(c.disc, {b, b});
        if (sign != undecided && !(ends_touch && sign == 1)) equal(sign, right);
      }
    }
  }
  CHECK(dyadic >= 100);
}

TEST(discs_with_a_center_of_quarters_are_found) {
  const SegmentSites sites({{0, 0}, {3, 0}, {0, 5}, {3, 5}}, Ends{{0, 1}});
  VoronoiRecord v{};
  v.sites = {0, 1, 2};
  v.x = 1.5;
  v.y = 2.5;
  v.radius = std::hypot(1.5, 2.5);
  const auto disc = dyadic_disc(sites, v);
  CHECK(disc && disc->x() == 1.5 && disc->y() == 2.5 && disc->radius() == v.radius);
  CHECK(disc->sign(sites.segment(4)) == -1);
  v.sites = {1, 0, 2};  // clockwise
  CHECK(!dyadic_disc(sites, v));
  v.sites = {0, 1, 2};
  v.x = 1.75;
  CHECK(!dyadic_disc(sites, v));
}

TEST(contacts_of_drawn_discs_are_in_order) {
  std::uint64_t seed = 41;
  for (const std::int64_t most : sizes) {
    for (const Configuration& c : configurations(seed++, most, 150)) {
      const auto& [p, q, r] = c.lattice_sites;
      CHECK(contacts_in_order(c.disc, std::array{p, q, r}));
      CHECK(contacts_in_order(c.disc, std::array{r, p, q}));
      CHECK(!contacts_in_order(c.disc, std::array{q, p, r}));
    }
  }
}

TEST(a_segment_comes_after_its_end_on_the_left) {
  const auto disc =
      find_exact_disc(std::array<LatticeSite, 3>{{{{0, -5}, {0, -5}}, {{4, 3}, {4, 3}}, {{-3, 4}, {-3, 4}}}});
  const LatticeSite end{{0, -5}, {0, -5}}, from_end{{0, -5}, {9, -5}}, to_end{{-9, -5}, {0, -5}},
      other{{3, 4}, {3, 4}};
  CHECK(contacts_in_order(*disc, std::array{end, from_end, other}));
  CHECK(!contacts_in_order(*disc, std::array{from_end, end, other}));
  CHECK(contacts_in_order(*disc, std::array{to_end, end, from_end, other}));
  CHECK(!contacts_in_order(*disc, std::array{end, to_end, other}));
}
