// The exact signs of the segment Voronoi diagram, for the tests.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bindings/support/arrays.hpp"
#include "bindings/testing/rooms.hpp"
#include "core/kernel/lattice.hpp"
#include "core/segment_voronoi/discs/exact_signs.hpp"

namespace vorotool::bindings::testing {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using core::kernel::LatticePoint;
using core::kernel::LatticeSite;
using core::segment_voronoi::discs::SiteTriple;

// What stands for a sign where no disc touches the sites.
constexpr std::int8_t no_disc = 2;

// Rows of sites, each of four columns: the ends' coordinates, equal for a point.
template <std::size_t n>
using SiteRows = Aligned<const std::int32_t, nb::shape<-1, n, 4>, nb::c_contig, nb::device::cpu>;

LatticePoint lattice_point(const std::int32_t* values) {
  for (int i = 0; i < 2; ++i) {
    if (std::abs(std::int64_t{values[i]}) > core::kernel::lattice_limit)
      throw nb::index_error("beyond the lattice");
  }
  return {values[0], values[1]};
}

template <std::size_t n>
std::vector<LatticeSite> sites_of(const SiteRows<n>& rows) {
  std::vector<LatticeSite> sites;
  sites.reserve(n * rows.shape(0));
  for (std::size_t i = 0; i < n * rows.shape(0); ++i) {
    const std::int32_t* values = rows.data() + 4 * i;
    sites.push_back({lattice_point(values), lattice_point(values + 2)});
  }
  return sites;
}

// sign(sites) for each row.
template <std::size_t n, class Sign>
auto signs(const SiteRows<n>& rows, Sign sign) {
  const std::vector<LatticeSite> sites = sites_of<n>(rows);
  std::vector<std::int8_t> result(rows.shape(0));
  {
    const nb::gil_scoped_release released;
    for (std::size_t k = 0; k < result.size(); ++k) {
      try {
        result[k] = static_cast<std::int8_t>(sign(sites.data() + n * k));
      } catch (const core::segment_voronoi::discs::NoDisc&) {
        result[k] = no_disc;
      }
    }
  }
  return to_numpy(std::move(result));
}

SiteTriple triple(const LatticeSite* first) { return SiteTriple(first, 3); }

// Three sites of a disc, then the query.
auto clearance_signs(SiteRows<4> rows) {
  return signs<4>(rows, [](const LatticeSite* s) {
    return core::segment_voronoi::discs::exact_clearance_sign(triple(s), s[3]);
  });
}

// Three sites each of two discs.
auto same_disc(SiteRows<6> rows) {
  return signs<6>(rows, [](const LatticeSite* s) {
    return core::segment_voronoi::discs::exact_same_disc(triple(s), triple(s + 3)) ? 1 : 0;
  });
}

// The edge's two sites, three sites each of two discs, then the query.
auto edge_clearance_signs(SiteRows<9> rows) {
  return signs<9>(rows, [](const LatticeSite* s) {
    return core::segment_voronoi::discs::exact_edge_clearance_sign(s[0], s[1], triple(s + 2), triple(s + 5),
                                                                   s[8]);
  });
}

// (k, 3) x, y and radius; NaN where there is no disc.
auto rounded_discs(SiteRows<3> rows) {
  const std::vector<LatticeSite> sites = sites_of<3>(rows);
  core::base::LargeArray<double> result(3 * rows.shape(0));
  for (std::size_t k = 0; k < rows.shape(0); ++k) {
    core::segment_voronoi::discs::RoundedDisc disc{NAN, NAN, NAN};
    try {
      disc = core::segment_voronoi::discs::exact_disc_rounded(triple(sites.data() + 3 * k));
    } catch (const core::segment_voronoi::discs::NoDisc&) {
    }
    double* row = result.data() + 3 * k;
    row[0] = disc.x, row[1] = disc.y, row[2] = disc.radius;
  }
  return to_numpy(std::move(result), {rows.shape(0), 3});
}

}  // namespace

void bind_exact_signs(nb::module_& room) {
  room.def("clearance_signs", &clearance_signs, "sites"_a, "(k, 4, 4): a disc, and the query.");
  room.def("same_disc", &same_disc, "sites"_a, "(k, 6, 4): two discs.");
  room.def("edge_clearance_signs", &edge_clearance_signs, "sites"_a,
           "(k, 9, 4): the edge's two sites, two discs, and the query.");
  room.def("discs", &rounded_discs, "sites"_a,
           "(k, 3) x, y and radius of (k, 3, 4) discs; NaN where there is none.");
}

}  // namespace vorotool::bindings::testing
