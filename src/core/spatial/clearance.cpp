#include "core/spatial/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.hpp"
#include "core/spatial/obb_tree.hpp"

namespace vorotool::core::spatial {

double closed_distance(const kernel::LatticeSite& site, const kernel::Point& place) {
  double x = place.x - site.a.x, y = place.y - site.a.y;
  if (!site.is_point()) {
    const kernel::LatticeVector along = site.b - site.a;
    const double ux = static_cast<double>(along.x), uy = static_cast<double>(along.y);
    const double square = static_cast<double>(kernel::norm2(along));
    const double t = ux * x + uy * y;
    if (t >= square) {
      x = place.x - site.b.x;
      y = place.y - site.b.y;
    } else if (t > 0) {
      return std::abs(ux * y - uy * x) / std::sqrt(square);
    }
  }
  return std::sqrt(x * x + y * y);
}

std::vector<double> clearances(std::span<const kernel::LatticeSite> sites,
                               std::span<const kernel::Point> places, std::span<const double> reach,
                               unsigned threads, const base::Monitor& monitor) {
  constexpr std::size_t grain = 1 << 12;  // places a piece: some milliseconds
  std::vector<double> found(places.size(), std::numeric_limits<double>::infinity());
  const ObbTree hierarchy(sites, threads, monitor);
  base::for_items(places.size(), grain, threads, monitor, [&](std::size_t i) {
    hierarchy.near(places[i].x, places[i].y, reach[i], [&](std::uint32_t site) {
      found[i] = std::min(found[i], closed_distance(sites[site], places[i]));
      return true;
    });
  });
  return found;
}

}  // namespace vorotool::core::spatial
