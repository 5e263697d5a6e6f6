// The disc that touches three sites, from approximate values, with a proved bound of its error.
#pragma once

#include <array>
#include <optional>

#include "core/kernel/lattice.hpp"
#include "core/numbers/double_double.hpp"

namespace vorotool::core::segment_voronoi::discs {

// The equations of a disc (x, y, r): it touches the point a; or it is tangent to the line through a and b; or
// its center is across the segment from a to b at a, where a is a site that the disc touches too.
struct DiscCondition {
  enum class Kind { point, tangent, across };
  Kind kind;
  kernel::LatticePoint a, b;
};

struct CertifiedDisc {
  numbers::DoubleDouble x, y, radius;
  double error;  // bounds the errors of x, y and radius
};

// The one disc that meets the conditions near the given values, if Newton's method shows that there is one,
// with an error below 2^-56 of the radius. Which of the tangent discs it is, is for the caller to find out.
std::optional<CertifiedDisc> certify_disc(const std::array<DiscCondition, 3>& conditions, double x, double y,
                                          double radius);

}  // namespace vorotool::core::segment_voronoi::discs
