// An exact check of a planar straight-line graph that knows its arrays only, not how they were made.
#pragma once

#include "core/base/fault.hpp"
#include "core/base/monitor.hpp"
#include "core/kernel/planar_graph_view.hpp"

namespace vorotool::core::arrangement {

// What is wrong, in words: the first fault of the first check that fails. Nothing if the points are distinct
// and within the lattice, the ends of segments are different points, no two segments have both ends in
// common, no point lies inside a segment, no two segments cross, and the faces, if there are any, are the
// same around every corner and different between faces that have nothing in common.
base::Fault find_fault(const kernel::PlanarGraphView& graph, const base::Monitor& monitor);

}  // namespace vorotool::core::arrangement
