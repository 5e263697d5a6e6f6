// The sites of a segment Voronoi diagram in the order in which the engine works on them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/kernel/lattice.hpp"

namespace vorotool::core::segment_voronoi::discs {

// Points come first, then open segments, then the symbolic site at infinity.
using SiteIndex = std::int32_t;

// An open segment from a to b.
struct SegmentSite {
  std::array<SiteIndex, 2> ends;  // the points a and b
  kernel::LatticePoint a, b;
  double ux, uy;  // its direction; relative errors at most 3 u, u = 2^-53
  double length;  // relative error at most 1.5 u

  kernel::LatticeVector direction() const { return b - a; }
};

class SegmentSites {
 public:
  SegmentSites() = default;
  // Distinct points, and the ends of each segment.
  SegmentSites(std::vector<kernel::LatticePoint> points, std::span<const std::array<SiteIndex, 2>> ends);

  std::size_t point_count() const { return points_.size(); }
  std::size_t segment_count() const { return segments_.size(); }
  SiteIndex infinite() const { return static_cast<SiteIndex>(points_.size() + segments_.size()); }

  bool is_point(SiteIndex site) const { return site < static_cast<SiteIndex>(points_.size()); }
  bool is_segment(SiteIndex site) const { return !is_point(site) && site != infinite(); }
  // Whether an open segment ends at a point.
  bool is_end(SiteIndex site, SiteIndex end) const {
    if (!is_segment(site)) return false;
    const SegmentSite& s = segment(site);
    return s.ends[0] == end || s.ends[1] == end;
  }

  const kernel::LatticePoint& point(SiteIndex site) const { return points_[static_cast<std::size_t>(site)]; }
  const SegmentSite& segment(SiteIndex site) const {
    return segments_[static_cast<std::size_t>(site) - points_.size()];
  }
  // From an end of a segment into it.
  kernel::LatticeVector direction_from(SiteIndex end, SiteIndex site) const {
    const SegmentSite& s = segment(site);
    return s.ends[0] == end ? s.direction() : -s.direction();
  }

  // A point or segment as the exact level wants it.
  kernel::LatticeSite lattice_site(SiteIndex site) const {
    if (is_point(site)) return {point(site), point(site)};
    return {segment(site).a, segment(site).b};
  }
  // A segment so turned that a disc is to its left.
  kernel::LatticeSite turned(SiteIndex site, bool disc_is_left) const {
    const SegmentSite& s = segment(site);
    return disc_is_left ? kernel::LatticeSite{s.a, s.b} : kernel::LatticeSite{s.b, s.a};
  }
  std::array<kernel::LatticeSite, 3> triple(const std::array<SiteIndex, 3>& sites) const {
    return {lattice_site(sites[0]), lattice_site(sites[1]), lattice_site(sites[2])};
  }

 private:
  std::vector<kernel::LatticePoint> points_;
  std::vector<SegmentSite> segments_;
};

}  // namespace vorotool::core::segment_voronoi::discs
