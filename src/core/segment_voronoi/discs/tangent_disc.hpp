// The disc that touches three sites: center and radius in closed form, with bounds of their errors.
#pragma once

#include <array>
#include <cstdint>

#include "core/numbers/double_double.hpp"
#include "core/segment_voronoi/discs/sites.hpp"

namespace vorotool::core::segment_voronoi::discs {

// A bound of the relative error of one operation.
template <class Real>
inline constexpr double roundoff = 0x1p-53;
// The largest of the bounds in core/numbers/double_double.hpp is 15 u^2 + 56 u^3 < 2^-102.
template <>
inline constexpr double roundoff<numbers::DoubleDouble> = 0x1p-102;

// The numbers relative to a lattice point keep their accuracy however far that is from the origin.
template <class Real>
struct TangentDisc {
  kernel::LatticePoint anchor;
  Real x, y;  // the center less the anchor
  Real radius;
  double position_error, radius_error;  // bounds, if known_within()

  // Whether the disc is known, and within this part of its radius. Where the formulas fail numbers are
  // infinite, NaN or negative.
  bool known_within(double part) const {
    const double size = static_cast<double>(radius);
    return size > 0 && position_error + radius_error <= part * size;
  }
};

// The disc whose touching points with the sites follow each other counter-clockwise as the sites do, to the
// left of segment i if bit i of `left` is set, else to the right.
// The result depends on the cyclic order of the sites alone, not on which comes first.
template <class Real>
TangentDisc<Real> tangent_disc(const SegmentSites& sites, std::array<SiteIndex, 3> triple, std::uint8_t left);

}  // namespace vorotool::core::segment_voronoi::discs
