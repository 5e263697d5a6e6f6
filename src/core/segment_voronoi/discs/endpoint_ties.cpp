#include "core/segment_voronoi/discs/endpoint_ties.hpp"

#include "core/numbers/int128.hpp"

namespace vorotool::core::segment_voronoi::discs {

using kernel::dot;
using kernel::LatticeVector;
using numbers::int128;

// With n across the touched segment and w = q - p the centre is p + t n where t = |w|^2 / (2 n w) > 0, and
// (centre - q) d has the sign of |w|^2 (n d) - 2 (n w) (w d). Both products are below 2^127
// (core/kernel/lattice_point.hpp).
std::optional<int> sign_along_from_end(const SegmentSites& sites, const VoronoiRecord& v, SiteIndex q,
                                       SiteIndex segment) {
  const int at = v.find(q);
  if (at < 0) return std::nullopt;
  for (const int touched : {following(at), preceding(at)}) {
    const SiteIndex own = v.sites[static_cast<std::size_t>(touched)];
    const SiteIndex p = v.sites[static_cast<std::size_t>(3 - at - touched)];
    if (!sites.is_end(own, p)) continue;
    const LatticeVector left = kernel::left_of(sites.segment(own).direction());
    const LatticeVector n = v.is_left(touched) ? left : -left;
    const LatticeVector w = sites.point(q) - sites.point(p), d = sites.direction_from(q, segment);
    const int128 a = int128{kernel::norm2(w)} * dot(n, d), b = 2 * int128{dot(n, w)} * dot(w, d);
    return (a > b) - (a < b);
  }
  return std::nullopt;
}

}  // namespace vorotool::core::segment_voronoi::discs
