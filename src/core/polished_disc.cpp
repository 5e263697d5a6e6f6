#include "core/polished_disc.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "core/dyadic_disc.hpp"
#include "core/segment_exact.hpp"
#include "core/tangent_disc.hpp"

namespace vorotool::core {
namespace {

// 64 roundings of the radius: the closed forms without cancellation stay below (core/tangent_disc.cpp), and
// mostly err by a few.
constexpr double sharp = 64 * unit_roundoff;
// A centre far from the origin is rounded there, which put_disc() counts with 2 roundings of the coordinates.
constexpr double rounded = 4 * unit_roundoff;
// Numbers of 106 bits that are known as well as this round as if they were exact, but for one in 2^7.
constexpr double nearly_exact = 0x1p-60;

bool is_sharp(const VoronoiRecord& v) {
  const double size = std::abs(v.x) + std::abs(v.y);
  return static_cast<double>(v.position_error) <= rounded * size + sharp * v.radius &&
         static_cast<double>(v.radius_error) <= sharp * v.radius;
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

std::optional<PolishedDisc> by_double_double(const SegmentSites& sites,
                                             const std::array<SiteIndex, 3>& triple, std::uint8_t left) {
  const TangentDisc<DoubleDouble> disc = tangent_disc<DoubleDouble>(sites, triple, left);
  const DoubleDouble x = DoubleDouble(static_cast<double>(disc.anchor.x)) + disc.x;
  const DoubleDouble y = DoubleDouble(static_cast<double>(disc.anchor.y)) + disc.y;
  const double radius = disc.radius.head;
  const double size = std::abs(x.head) + std::abs(y.head) + radius;
  const bool known = disc.position_error <= nearly_exact * size && disc.radius_error <= nearly_exact * radius;
  if (!known) return std::nullopt;
  return PolishedDisc{x.head, y.head, radius};
}

// Calls solve(triple, left) for the triples of contacts in order until one gives a disc.
template <class Solve>
std::optional<PolishedDisc> first_of_triples(const SegmentSites& sites, std::span<const Contact> contacts,
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

std::optional<PolishedDisc> by_exact_level(const SegmentSites& sites,
                                           const std::array<SiteIndex, 3>& triple) {
  try {
    const RoundedDisc disc = exact_disc_rounded(sites.triple(triple));
    return PolishedDisc{disc.x, disc.y, disc.radius};
  } catch (const NoDisc&) {
    return std::nullopt;  // two collinear segments
  }
}

}  // namespace

PolishedDisc polished_disc(const SegmentSites& sites, const VoronoiRecord& v,
                           std::span<const Contact> contacts) {
  if (v.radius == 0 || (contacts.size() == 3 && is_sharp(v))) return {v.x, v.y, v.radius};
  if (contacts.size() > 3) {
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

}  // namespace vorotool::core
