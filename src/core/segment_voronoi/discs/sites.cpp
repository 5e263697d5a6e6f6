#include "core/segment_voronoi/discs/sites.hpp"

#include <cmath>
#include <utility>

namespace vorotool::core::segment_voronoi::discs {

SegmentSites::SegmentSites(std::vector<kernel::LatticePoint> points,
                           std::span<const std::array<SiteIndex, 2>> ends)
    : points_(std::move(points)) {
  segments_.reserve(ends.size());
  for (const auto& [a, b] : ends) {
    SegmentSite s{{a, b}, point(a), point(b), 0, 0, 0};
    const kernel::LatticeVector d = s.direction();
    // The square is exact in 64 bits; converting it errs by u, halved by the root, which errs by u.
    s.length = std::sqrt(static_cast<double>(kernel::dot(d, d)));
    s.ux = static_cast<double>(d.x) / s.length;
    s.uy = static_cast<double>(d.y) / s.length;
    segments_.push_back(s);
  }
}

}  // namespace vorotool::core::segment_voronoi::discs
