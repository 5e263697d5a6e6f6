// The decisions of the segment Voronoi engine about a few sites, for the tests.
#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bindings/support/arrays.hpp"
#include "bindings/testing/rooms.hpp"
#include "core/segment_voronoi/build/coincident_vertices.hpp"
#include "core/segment_voronoi/build/insertion_predicates.hpp"
#include "core/segment_voronoi/build/segment_insertion.hpp"
#include "core/segment_voronoi/discs/exact_signs.hpp"

namespace vorotool::bindings::testing {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using core::kernel::LatticePoint;
using core::kernel::LatticeSite;
using core::segment_voronoi::discs::SiteIndex;
using core::segment_voronoi::discs::VoronoiRecord;

template <std::size_t n>
using SiteRows = Aligned<const std::int32_t, nb::shape<-1, n, 4>, nb::c_contig, nb::device::cpu>;

// Sites of a row, numbered as the engine does; those that occur twice have one number.
class FewSites {
 public:
  FewSites(const std::int32_t* row, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i, row += 4) sites_.push_back({{row[0], row[1]}, {row[2], row[3]}});
    std::vector<LatticePoint> points;
    for (const LatticeSite& site : sites_) {
      for (const LatticePoint& p : {site.a, site.b}) {
        if (std::ranges::find(points, p) == points.end()) points.push_back(p);
      }
    }
    const auto number_of = [&](const LatticePoint& p) {
      return static_cast<SiteIndex>(std::ranges::find(points, p) - points.begin());
    };
    std::vector<std::array<SiteIndex, 2>> ends;
    for (const LatticeSite& site : sites_) {
      std::array<SiteIndex, 2> pair{number_of(site.a), number_of(site.b)};
      const auto known = std::ranges::find(ends, pair);
      const auto place = static_cast<SiteIndex>(known - ends.begin());
      number_.push_back(site.is_point() ? pair[0] : static_cast<SiteIndex>(points.size()) + place);
      if (!site.is_point() && known == ends.end()) ends.push_back(pair);
    }
    all_ = core::segment_voronoi::discs::SegmentSites(std::move(points), ends);
  }

  const core::segment_voronoi::discs::SegmentSites& all() const { return all_; }
  SiteIndex number(std::size_t i) const { return number_[i]; }

  // The vertex of three of the sites; throws NoDisc.
  VoronoiRecord vertex(std::size_t first) const {
    VoronoiRecord v{};
    const core::segment_voronoi::discs::RoundedDisc disc = core::segment_voronoi::discs::exact_disc_rounded(
        core::segment_voronoi::discs::SiteTriple(sites_.data() + first, 3));
    for (std::size_t i = 0; i < 3; ++i) {
      v.sites[i] = number_[first + i];
      if (!all_.is_segment(v.sites[i])) continue;
      const core::segment_voronoi::discs::SegmentSite& s = all_.segment(v.sites[i]);
      const bool is_left = s.ux * (disc.y - s.a.y) > s.uy * (disc.x - s.a.x);
      v.left = static_cast<std::uint8_t>(v.left | is_left << i);
    }
    core::segment_voronoi::build::compute_disc(all_, v);
    return v;
  }

 private:
  std::vector<LatticeSite> sites_;
  std::vector<SiteIndex> number_;
  core::segment_voronoi::discs::SegmentSites all_;
};

// (k, 2): whether the fourth site, a segment, is in conflict with the vertex of the three others, and the
// level that tells: 0 doubles, 1 integers, 2 double-double, 3 multiprecision.
auto conflicts(SiteRows<4> rows) {
  core::base::LargeArray<std::int8_t> result(2 * rows.shape(0));
  for (std::size_t k = 0; k < rows.shape(0); ++k) {
    const FewSites sites(rows.data() + 16 * k, 4);
    core::segment_voronoi::build::InsertionPredicates predicates(sites.all());
    const core::segment_voronoi::build::SegmentQuery query(sites.all(), sites.number(3));
    result.data()[2 * k] = predicates.in_conflict(sites.vertex(0), query);
    const core::segment_voronoi::build::EscalationCounts& counts = predicates.counts();
    result.data()[2 * k + 1] =
        static_cast<std::int8_t>(counts.integer + 2 * counts.double_double + 3 * counts.exact);
  }
  return to_numpy(std::move(result), {rows.shape(0), 2});
}

// Whether the vertices of the first and last three sites coincide, which share two sites.
auto coincidences(SiteRows<6> rows) {
  core::base::LargeArray<std::int8_t> result(rows.shape(0));
  for (std::size_t k = 0; k < rows.shape(0); ++k) {
    const FewSites sites(rows.data() + 24 * k, 6);
    const VoronoiRecord u = sites.vertex(0), w = sites.vertex(3);
    int i = 0;
    while (i < 3 && w.find(u.sites[static_cast<std::size_t>(i)]) >= 0) ++i;
    if (i == 3) throw std::invalid_argument("the vertices share three sites");
    result.data()[k] = core::segment_voronoi::build::are_coincident(sites.all(), u, i, w);
  }
  return to_numpy(std::move(result), {rows.shape(0)});
}

}  // namespace

void bind_insertion_predicates(nb::module_& room) {
  room.def(
      "conflicts", &conflicts, "sites"_a,
      "(k, 2) of (k, 4, 4), a disc and a segment: in conflict; told by doubles, integers, double-double, "
      "exactly.");
  room.def("coincidences", &coincidences, "sites"_a, "(k, 6, 4): two discs that share two sites.");
}

}  // namespace vorotool::bindings::testing
