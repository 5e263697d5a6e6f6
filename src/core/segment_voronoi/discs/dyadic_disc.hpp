// Discs whose center is a lattice point of quarter units: grids and rectilinear shapes are full of them, and
// of ties between them. Integers decide there at once.
#pragma once

#include <cstdint>
#include <optional>

#include "core/numbers/int128.hpp"
#include "core/segment_voronoi/discs/records.hpp"
#include "core/segment_voronoi/discs/sites.hpp"

namespace vorotool::core::segment_voronoi::discs {

class DyadicDisc {
 public:
  // As InsertionPredicates::sign; undecided where the integers would not fit.
  int sign(const SegmentSite& query) const;

  bool same_center(const DyadicDisc& other) const { return x_ == other.x_ && y_ == other.y_; }
  // Exact.
  double x() const;
  double y() const;
  // Rounded.
  double radius() const;

 private:
  friend std::optional<DyadicDisc> dyadic_disc(const SegmentSites& sites, const VoronoiRecord& vertex);

  bool take_radius(const SegmentSites& sites, SiteIndex site);
  bool touches(const SegmentSites& sites, SiteIndex site, bool is_left) const;
  kernel::LatticeVector contact(const SegmentSites& sites, SiteIndex site, bool is_left) const;
  bool is_in_order(const SegmentSites& sites, const VoronoiRecord& vertex) const;
  numbers::int128 square_distance(const kernel::LatticePoint& p) const;

  std::int64_t x_, y_;      // the center, times `scale`
  numbers::int128 square_;  // of the radius, times the square of `scale`
};

// The disc of a vertex if it is one of these: it is that of the vertex because it touches the sites exactly,
// on the sides and in the order of the vertex, and no other disc does. The vertex's numbers only tell where
// to look.
std::optional<DyadicDisc> dyadic_disc(const SegmentSites& sites, const VoronoiRecord& vertex);

}  // namespace vorotool::core::segment_voronoi::discs
