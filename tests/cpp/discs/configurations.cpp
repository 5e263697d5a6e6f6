#include "discs/configurations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/numbers/sign.hpp"
#include "core/segment_voronoi/discs/exact_signs.hpp"

namespace vorotool::tests {

using namespace core::segment_voronoi::discs;
using core::kernel::cross;
using core::kernel::dot;
using core::kernel::LatticePoint;
using core::kernel::LatticeSite;
using core::numbers::RootNumber;
using core::numbers::sign_of;

namespace {

int side(const LatticeSite& line, const LatticePoint& p) {
  return sign_of(cross(line.b - line.a, p - line.a));
}

bool is_inside(const LatticePoint& p, const LatticeSite& segment) {
  return side(segment, p) == 0 && dot(segment.a - p, segment.b - p) < 0;
}

bool is_left(const ExactDisc& disc, const LatticeSite& segment) {
  const auto u = segment.b - segment.a, shift = disc.origin - segment.a;
  const RootNumber x = disc.x + disc.w * RootNumber(shift.x), y = disc.y + disc.w * RootNumber(shift.y);
  return (y * RootNumber(u.x) - x * RootNumber(u.y)).sign() > 0;
}

std::optional<Configuration> drawn(Random& random, std::int64_t most) {
  std::vector<LatticePoint> points;
  while (points.size() < 6) {
    const LatticePoint p = drawn_point(random, most);
    if (std::ranges::find(points, p) == points.end()) points.push_back(p);
  }
  Ends ends;
  for (int i = 0; i < 3; ++i) {
    const auto a = static_cast<SiteIndex>(random.whole(0, 5)), b = static_cast<SiteIndex>(random.whole(0, 4));
    ends.push_back({a, b < a ? b : b + 1});
  }
  std::array<SiteIndex, 3> triple;
  for (SiteIndex& site : triple) site = static_cast<SiteIndex>(random.whole(0, 8));
  return configuration_of(SegmentSites(points, ends), triple);
}

}  // namespace

std::optional<Configuration> configuration_of(SegmentSites sites, const std::array<SiteIndex, 3>& triple) {
  const auto lattice_sites = sites.triple(triple);
  for (std::size_t i = 0; i < 3; ++i) {
    if (cross_or_overlap(lattice_sites[i], lattice_sites[(i + 1) % 3])) return std::nullopt;
  }
  auto disc = find_exact_disc(lattice_sites);
  if (!disc || disc->z.sign() == 0) return std::nullopt;
  std::uint8_t left = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!touches(*disc, lattice_sites[i])) return std::nullopt;
    if (sites.is_segment(triple[i]) && is_left(*disc, lattice_sites[i]))
      left |= static_cast<std::uint8_t>(1U << i);
  }
  return Configuration{std::move(sites), triple, lattice_sites, std::move(*disc), left};
}

LatticePoint drawn_point(Random& random, std::int64_t most) {
  const auto next = [&] { return static_cast<std::int32_t>(random.whole(-most, most)); };
  const std::int32_t x = next();
  return {x, next()};
}

bool cross_or_overlap(const LatticeSite& s, const LatticeSite& t) {
  if (s == t || (s.a == t.b && s.b == t.a)) return true;
  for (const auto& [p, site] : {std::pair{s.a, t}, {s.b, t}, {t.a, s}, {t.b, s}}) {
    if (is_inside(p, site)) return true;
  }
  return side(s, t.a) * side(s, t.b) < 0 && side(t, s.a) * side(t, s.b) < 0;
}

std::vector<Configuration> configurations(std::uint64_t seed, std::int64_t most, std::size_t count) {
  Random random(seed);
  std::vector<Configuration> found;
  while (found.size() < count) {
    if (auto next = drawn(random, most)) found.push_back(std::move(*next));
  }
  return found;
}

bool Configuration::has_end_of(int i) const {
  const auto at = [&](int k) { return triple[static_cast<std::size_t>(k)]; };
  return sites.is_end(at(i), at(following(i))) || sites.is_end(at(i), at(preceding(i)));
}

// Where a point and its own segment are touched, the center is across that end.
std::optional<CertifiedDisc> Configuration::certified() const {
  std::array<DiscCondition, 3> conditions;
  for (std::size_t i = 0; i < 3; ++i) {
    const LatticeSite& s = lattice_sites[i];
    using enum DiscCondition::Kind;
    conditions[i] = {s.is_point() ? point : tangent, s.a, s.b};
    if (s.is_point()) continue;
    for (const SiteIndex other : triple) {
      if (sites.is_end(triple[i], other)) {
        const auto p = sites.point(other);
        conditions[i] = {across, p, p == s.a ? s.b : s.a};
      }
    }
  }
  const RoundedDisc near = rounded(disc);
  return certify_disc(conditions, near.x, near.y, near.radius);
}

VoronoiRecord Configuration::record() const {
  const RoundedDisc at = rounded(disc);
  VoronoiRecord v{};
  v.sites = triple;
  v.x = at.x;
  v.y = at.y;
  v.radius = at.radius;
  v.position_error = static_cast<float>(0x1p-50 * (std::abs(at.x) + std::abs(at.y)) + 0x1p-1000);
  v.radius_error = static_cast<float>(0x1p-50 * at.radius);
  v.left = left;
  return v;
}

}  // namespace vorotool::tests
