// An exact check of a segment Voronoi diagram that knows its arrays only, not how they were made.
#pragma once

#include "core/base/fault.hpp"
#include "core/base/monitor.hpp"
#include "core/segment_voronoi/build/diagram.hpp"

namespace vorotool::core::segment_voronoi::verify {

// The relative errors that values may have: of radii, and of coordinates by the largest of both and the
// radius. That is what the engine proves of its values (core/segment_voronoi/build/refined_disc.hpp); none
// was found to be off by more than four ulp.
inline constexpr double value_error_bound = 0x1p-48;

// What is wrong, in words: the first fault of the first check that fails. Nothing if the arrays are the
// Voronoi diagram of the sites, its values right to `value_error_bound`.
//
// That points are distinct is checked; that segments do not cross and hold no point inside is taken for
// granted.
base::Fault find_fault(const build::DiagramView& arrays, unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::segment_voronoi::verify
