// An exact check of a Delaunay triangulation that knows its arrays only, not how they were made.
#pragma once

#include "core/base/fault.hpp"
#include "core/base/monitor.hpp"
#include "core/delaunay/triangulation.hpp"

namespace vorotool::core::delaunay {

// What is wrong, in words: the first fault of the first check that fails. Nothing if the arrays are the
// Delaunay triangulation of the points, cocircular polygons being fans from their lexicographically smallest
// vertex, or the chain of fewer than three or of collinear points.
base::Fault find_fault(const TriangulationArrays& arrays, unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::delaunay
