#include "core/segment_voronoi/build/refined_disc.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "core/numbers/sign.hpp"
#include "core/segment_voronoi/discs/dyadic_disc.hpp"
#include "core/segment_voronoi/discs/exact_signs.hpp"
#include "core/segment_voronoi/discs/tangent_disc.hpp"

namespace vorotool::core::segment_voronoi::build {

using discs::SegmentSites;
using discs::SiteIndex;
using discs::VoronoiRecord;
using kernel::LatticePoint;
using numbers::DoubleDouble;

namespace {

// Closed forms of at most so many roundings of the radius are good enough
// (core/segment_voronoi/discs/tangent_disc.cpp).
constexpr double sharp = 10 * numbers::unit_roundoff;
// A center far from the origin is rounded there, which put_disc() counts with 2 roundings of the coordinates.
constexpr double rounded = 4 * numbers::unit_roundoff;
// Numbers of 106 bits that are known as well as this round as if they were exact, but for one in 2^7.
constexpr double nearly_exact = 0x1p-60;

bool is_sharp(const VoronoiRecord& v) {
  const double size = std::abs(v.x) + std::abs(v.y);
  return static_cast<double>(v.position_error) <= rounded * size + sharp * v.radius &&
         static_cast<double>(v.radius_error) <= sharp * v.radius;
}

// The end of a segment that is nearer to the center: what is measured from it is rounded least. Whichever way
// the segment is given, the ends are looked at in one order.
const LatticePoint& nearer_end(const discs::SegmentSite& s, const VoronoiRecord& v, bool is_left) {
  const LatticePoint &start = is_left ? s.a : s.b, &end = is_left ? s.b : s.a;
  const auto reach = [&](const LatticePoint& p) { return std::abs(v.x - p.x) + std::abs(v.y - p.y); };
  return reach(end) < reach(start) ? end : start;
}

// By how much the distance of a site from the center is more than the radius, and the unit vector from the
// site to the center, roughly.
struct Excess {
  double value, nx, ny;
  double reach;  // how far the lattice point is that the center is measured from
};

Excess excess_of(const SegmentSites& sites, const VoronoiRecord& v, const Contact& contact) {
  const bool is_point = sites.is_point(contact.site);
  const LatticePoint& from =
      is_point ? sites.point(contact.site) : nearer_end(sites.segment(contact.site), v, contact.is_left);
  const DoubleDouble dx = numbers::two_difference(v.x, from.x), dy = numbers::two_difference(v.y, from.y);
  const double reach = std::abs(dx.head) + std::abs(dy.head);
  const DoubleDouble radius(v.radius), square = radius * radius;
  if (is_point) {
    const double value = (dx * dx + dy * dy - square).head / (2 * v.radius);
    return {value, dx.head / v.radius, dy.head / v.radius, reach};
  }
  // The distance is K / L: K^2 - (r L)^2 = (K - r L) (K + r L).
  const discs::SegmentSite& s = sites.segment(contact.site);
  const kernel::LatticeVector d = s.direction();
  const double side = contact.is_left ? 1 : -1;
  const DoubleDouble K =
      dy * DoubleDouble(side * static_cast<double>(d.x)) - dx * DoubleDouble(side * static_cast<double>(d.y));
  const DoubleDouble difference = K * K - square * DoubleDouble(numbers::int128{kernel::dot(d, d)});
  const double value = difference.head / (s.length * (K.head + v.radius * s.length));
  return {value, -side * s.uy, side * s.ux, reach};
}

// One step of Newton, with the distances in 106 bits. With D the determinant of the differences of unit
// vectors, which are right to 2^-44, a step of length h is right to h 2^-42 / D; what it leaves out are
// squares, 4 h^2 / (D r); distances are right to 2^-97 of the reach, which counts 4 / D times. Nothing is
// told unless each is less than an eighth of a rounding of the radius.
std::optional<RefinedDisc> by_newton(const SegmentSites& sites, const VoronoiRecord& v,
                                     std::span<const Contact> contacts) {
  const Excess a = excess_of(sites, v, contacts[0]), b = excess_of(sites, v, contacts[1]),
               c = excess_of(sites, v, contacts[2]);
  const double bx = b.nx - a.nx, by = b.ny - a.ny, cx = c.nx - a.nx, cy = c.ny - a.ny;
  const double det = bx * cy - by * cx, b_value = a.value - b.value, c_value = a.value - c.value;
  const double dx = (b_value * cy - by * c_value) / det, dy = (bx * c_value - cx * b_value) / det;
  const double dr = a.value + a.nx * dx + a.ny * dy;
  const double step = std::abs(dx) + std::abs(dy) + std::abs(dr), size = std::abs(det) * v.radius;
  const double reach = std::max({a.reach, b.reach, c.reach, v.radius});
  const bool known = step * 0x1p-42 <= 0x1p-56 * size && 4 * step * step <= 0x1p-56 * size * v.radius &&
                     reach * 0x1p-95 <= 0x1p-56 * size;
  if (!known) return std::nullopt;
  return RefinedDisc{v.x + dx, v.y + dy, v.radius + dr};
}

// A triple of contacts that determines its disc: not a point and two of its own segments.
bool determines(const SegmentSites& sites, const std::array<SiteIndex, 3>& triple) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (sites.is_point(triple[i]) && sites.is_end(triple[(i + 1) % 3], triple[i]) &&
        sites.is_end(triple[(i + 2) % 3], triple[i])) {
      return false;
    }
  }
  return true;
}

std::optional<RefinedDisc> by_double_double(const SegmentSites& sites, const std::array<SiteIndex, 3>& triple,
                                            std::uint8_t left) {
  const discs::TangentDisc<DoubleDouble> disc = discs::tangent_disc<DoubleDouble>(sites, triple, left);
  const DoubleDouble x = DoubleDouble(static_cast<double>(disc.anchor.x)) + disc.x;
  const DoubleDouble y = DoubleDouble(static_cast<double>(disc.anchor.y)) + disc.y;
  const double radius = disc.radius.head;
  const double size = std::abs(x.head) + std::abs(y.head) + radius;
  const bool known = disc.position_error <= nearly_exact * size && disc.radius_error <= nearly_exact * radius;
  if (!known) return std::nullopt;
  return RefinedDisc{x.head, y.head, radius};
}

// Calls solve(triple, left) for the triples of contacts in order until one gives a disc.
template <class Solve>
std::optional<RefinedDisc> first_of_triples(const SegmentSites& sites, std::span<const Contact> contacts,
                                            Solve solve) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t j = i + 1; j < contacts.size(); ++j) {
      for (std::size_t k = j + 1; k < contacts.size(); ++k) {
        const std::array<SiteIndex, 3> triple{contacts[i].site, contacts[j].site, contacts[k].site};
        if (!determines(sites, triple)) continue;
        const int left = contacts[i].is_left | contacts[j].is_left << 1 | contacts[k].is_left << 2;
        if (const auto disc = solve(triple, static_cast<std::uint8_t>(left))) return disc;
      }
    }
  }
  return std::nullopt;
}

std::optional<RefinedDisc> by_exact_level(const SegmentSites& sites, const std::array<SiteIndex, 3>& triple) {
  try {
    const discs::RoundedDisc disc = discs::exact_disc_rounded(sites.triple(triple));
    return RefinedDisc{disc.x, disc.y, disc.radius};
  } catch (const discs::NoDisc&) {
    return std::nullopt;  // two collinear segments
  }
}

}  // namespace

RefinedDisc refined_disc(const SegmentSites& sites, const VoronoiRecord& v,
                         std::span<const Contact> contacts) {
  if (v.radius == 0 || (contacts.size() == 3 && is_sharp(v))) return {v.x, v.y, v.radius};
  if (contacts.size() == 3) {
    if (const auto disc = by_newton(sites, v, contacts)) return *disc;
  } else {
    if (const auto disc = dyadic_disc(sites, v)) return {disc->x(), disc->y(), disc->radius()};
  }
  auto disc = first_of_triples(sites, contacts, [&](const auto& triple, std::uint8_t left) {
    return by_double_double(sites, triple, left);
  });
  if (disc) return *disc;
  disc = first_of_triples(sites, contacts,
                          [&](const auto& triple, std::uint8_t) { return by_exact_level(sites, triple); });
  if (!disc) throw std::logic_error("the sites of a Voronoi vertex have no disc");
  return *disc;
}

}  // namespace vorotool::core::segment_voronoi::build
