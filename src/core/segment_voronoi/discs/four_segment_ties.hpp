// Ties between four segments, by integers alone.
#pragma once

#include <array>

#include "core/kernel/lattice_point.hpp"

namespace vorotool::core::segment_voronoi::discs {

// Four segments, each with a circle to its left from a to b. A circle touches the lines of the first three,
// and one those of the last three: whether it is one and the same. False also where two of the lines that one
// circle touches are one.
bool is_one_circle(const std::array<kernel::LatticeSite, 4>& segments);

}  // namespace vorotool::core::segment_voronoi::discs
