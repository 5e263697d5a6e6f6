#include "core/segment_voronoi/build/coincident_vertices.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/segment_voronoi/discs/dyadic_disc.hpp"
#include "core/segment_voronoi/discs/exact_signs.hpp"
#include "core/segment_voronoi/discs/tangent_disc.hpp"
#include "core/segment_voronoi/discs/ties.hpp"

namespace vorotool::core::segment_voronoi::build {

using discs::SegmentSites;
using discs::SiteIndex;
using discs::VoronoiRecord;
using numbers::DoubleDouble;

namespace {

// Whether the centers are surely apart, given the differences of their coordinates.
bool are_apart(double dx, double dy, double error) { return std::max(std::abs(dx), std::abs(dy)) > error; }

bool are_apart_in_double_double(const SegmentSites& sites, const VoronoiRecord& u, const VoronoiRecord& w) {
  const auto a = discs::tangent_disc<DoubleDouble>(sites, u.sites, u.left);
  const auto b = discs::tangent_disc<DoubleDouble>(sites, w.sites, w.left);
  if (!a.known_within(1) || !b.known_within(1)) return false;
  const auto difference = [](const DoubleDouble& p, const DoubleDouble& q, double anchors) {
    return (p - q + DoubleDouble(anchors)).head;
  };
  const double dx = difference(a.x, b.x, static_cast<double>(a.anchor.x) - b.anchor.x);
  const double dy = difference(a.y, b.y, static_cast<double>(a.anchor.y) - b.anchor.y);
  // Three numbers are summed in two operations.
  const double size = std::abs(a.x.head) + std::abs(a.y.head) + std::abs(b.x.head) + std::abs(b.y.head) +
                      std::abs(dx) + std::abs(dy);
  return are_apart(dx, dy, a.position_error + b.position_error + 4 * discs::roundoff<DoubleDouble> * size);
}

// Vertices on the normals of two segments at their common end are at one place if the normals are one line.
std::optional<bool> by_common_end(const SegmentSites& sites, const VoronoiRecord& u, int i,
                                  const VoronoiRecord& w) {
  const auto [right, left] = discs::sites_of_edge(u, i);
  for (const SiteIndex end : {right, left}) {
    if (!sites.is_point(end)) continue;
    const SiteIndex s = u.sites[static_cast<std::size_t>(i)];
    for (const SiteIndex t : w.sites) {
      if (t == s || t == right || t == left || !sites.is_end(s, end) || !sites.is_end(t, end)) continue;
      return kernel::cross(sites.segment(s).direction(), sites.segment(t).direction()) == 0;
    }
  }
  return std::nullopt;
}

// u touches a segment at its end and goes through q, w touches another one at q, and both share q and one
// more site. So u is w if it touches that segment too: on the same side, being near, there is one such disc.
std::optional<bool> by_two_ends(const SegmentSites& sites, const VoronoiRecord& u, const VoronoiRecord& w) {
  for (const SiteIndex q : u.sites) {
    if (!sites.is_point(q) || w.find(q) < 0) continue;
    for (const SiteIndex t : w.sites) {
      if (!sites.is_end(t, q)) continue;
      if (const std::optional<int> along = discs::sign_along_from_end(sites, u, q, t)) return *along == 0;
    }
  }
  return std::nullopt;
}

// Two vertices of three segments each, which share those beside edge i of u.
bool by_four_lines(const SegmentSites& sites, const VoronoiRecord& u, int i, const VoronoiRecord& w) {
  const auto [right, left] = discs::sites_of_edge(u, i);
  const auto line_of = [&](const VoronoiRecord& v, SiteIndex site) {
    return sites.turned(site, v.is_left(v.find(site)));
  };
  const auto third = std::ranges::find_if(
      w.sites, [&, a = right, b = left](SiteIndex site) { return site != a && site != b; });
  if (third == w.sites.end()) return false;
  for (const SiteIndex site : {u.sites[static_cast<std::size_t>(i)], right, left, *third}) {
    if (!sites.is_segment(site)) return false;
  }
  return discs::is_one_circle({line_of(u, u.sites[static_cast<std::size_t>(i)]), line_of(u, right),
                               line_of(u, left), line_of(w, *third)});
}

}  // namespace

bool are_coincident(const SegmentSites& sites, const VoronoiRecord& u, int i, const VoronoiRecord& w) {
  const double error = static_cast<double>(u.position_error) + static_cast<double>(w.position_error);
  if (are_apart(u.x - w.x, u.y - w.y, error)) return false;
  // Only corners have radius 0, and those of one point are at one place.
  if (u.radius == 0 || w.radius == 0) return u.radius == w.radius;
  if (const std::optional<bool> known = by_common_end(sites, u, i, w)) return *known;
  if (const std::optional<bool> known = by_two_ends(sites, u, w)) return *known;
  if (const std::optional<bool> known = by_two_ends(sites, w, u)) return *known;
  const std::optional<discs::DyadicDisc> a = dyadic_disc(sites, u), b = dyadic_disc(sites, w);
  if (a && b) return a->same_center(*b);
  if (are_apart_in_double_double(sites, u, w)) return false;
  return by_four_lines(sites, u, i, w) ||
         discs::exact_same_disc(sites.triple(u.sites), sites.triple(w.sites));
}

}  // namespace vorotool::core::segment_voronoi::build
