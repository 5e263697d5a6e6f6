// The engine's decisions, whichever level takes them, are those of the exact one.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "check.hpp"
#include "core/segment_voronoi/build/coincident_vertices.hpp"
#include "core/segment_voronoi/build/insertion_predicates.hpp"
#include "core/segment_voronoi/discs/exact_signs.hpp"
#include "discs/configurations.hpp"

using namespace vorotool::core::segment_voronoi;
using namespace vorotool::tests;
using discs::SiteIndex;
using vorotool::core::kernel::LatticePoint;
using vorotool::core::kernel::LatticeSite;

namespace {

// Points 0, 1, 2 and their images 3, 4, 5 in a vertical line; segments 6 and 8, and their images 7 and 9. The
// disc of a site, its image and segment 6 touches segment 7 as well, most often at a place that is not
// rational.
discs::SegmentSites mirrored_sites(Random& random) {
  const std::int64_t most =
      std::array{2, 3, 10, 1000, 1 << 20, 1 << 26}[static_cast<std::size_t>(random.whole(0, 5))];
  const std::int64_t far = (1 << 30) - 1 - most;
  const auto x = static_cast<std::int32_t>(random.whole(-far, far)),
             y = static_cast<std::int32_t>(random.whole(-far, far));
  std::vector<LatticePoint> points, images;
  while (points.size() < 3) {
    const auto [dx, dy] = drawn_point(random, most);
    const LatticePoint p{x + dx, y + dy}, image{x - dx, y + dy};
    if (dx == 0 || std::ranges::count(points, p) + std::ranges::count(images, p) > 0) continue;
    points.push_back(p);
    images.push_back(image);
  }
  points.insert(points.end(), images.begin(), images.end());
  Ends ends;
  for (int k = 0; k < 2; ++k) {
    const auto a = static_cast<SiteIndex>(random.whole(0, 2));
    const auto b = static_cast<SiteIndex>((a + random.whole(1, 5)) % 6);
    ends.push_back({a, b});
    ends.push_back({a + 3, (b + 3) % 6});
  }
  return {points, ends};
}

// Sites that are drawn in any way, and mirrored ones.
std::vector<Configuration> all_kinds(std::uint64_t seed, std::size_t count) {
  std::vector<Configuration> found;
  for (const std::int64_t most : {3, 20, (1 << 30) - 1}) {
    for (Configuration& c : configurations(seed++, most, count / 6)) found.push_back(std::move(c));
  }
  Random random(seed);
  while (found.size() < count) {
    const discs::SegmentSites sites = mirrored_sites(random);
    const bool of_points = random.whole(0, 1) == 0;
    const SiteIndex site = of_points ? static_cast<SiteIndex>(random.whole(0, 2)) : 8;
    const SiteIndex image = site + (of_points ? 3 : 1);
    for (const std::array<SiteIndex, 3>& triple : {std::array{site, SiteIndex{6}, image}, {image, 6, site}}) {
      if (auto c = configuration_of(sites, triple)) found.push_back(std::move(*c));
    }
  }
  return found;
}

// What may be in a diagram with the three sites, from some site on: it crosses none of them, and the disc holds
// none of its ends.
std::vector<SiteIndex> others(const Configuration& c, SiteIndex first) {
  std::vector<SiteIndex> found;
  for (SiteIndex s = first; s < c.sites.infinite(); ++s) {
    const LatticeSite query = c.sites.lattice_site(s);
    bool fits = true;
    for (const LatticeSite& own : c.lattice_sites) fits = fits && !cross_or_overlap(query, own);
    for (const LatticePoint& end : {query.a, query.b})
      fits = fits && discs::clearance_sign(c.disc, {end, end}) >= 0;
    if (fits) found.push_back(s);
  }
  return found;
}

}  // namespace

TEST(every_level_tells_what_the_exact_one_does) {
  int by_doubles = 0, ties_by_integers = 0, ties_exactly = 0;
  for (const Configuration& c : all_kinds(1, 3000)) {
    for (const SiteIndex s : others(c, 6)) {
      build::InsertionPredicates predicates(c.sites);
      const int sign = discs::clearance_sign(c.disc, c.sites.lattice_site(s));
      equal(predicates.in_conflict(c.record(), build::SegmentQuery(c.sites, s)), sign < 0);
      const build::EscalationCounts& counts = predicates.counts();
      by_doubles += sign != 0 && counts.integer + counts.double_double + counts.exact == 0;
      ties_by_integers += sign == 0 && counts.integer > 0;
      ties_exactly += sign == 0 && counts.exact > 0;
    }
  }
  CHECK(by_doubles > 100);
  CHECK(ties_by_integers > 100);
  CHECK(ties_exactly > 30);
}

TEST(vertices_coincide_where_their_discs_are_one) {
  int same = 0, different = 0;
  for (const Configuration& c : all_kinds(5, 2000)) {
    for (const SiteIndex other : others(c, 0)) {
      for (int i = 0; i < 3; ++i) {
        const SiteIndex right = c.triple[static_cast<std::size_t>(discs::following(i))],
                        left = c.triple[static_cast<std::size_t>(discs::preceding(i))];
        const auto w = configuration_of(c.sites, {right, other, left});
        if (!w) continue;
        const bool are_one = discs::exact_same_disc(c.lattice_sites, w->lattice_sites);
        equal(build::are_coincident(c.sites, c.record(), i, w->record()), are_one);
        ++(are_one ? same : different);
      }
    }
  }
  CHECK(same > 100);
  CHECK(different > 100);
}
