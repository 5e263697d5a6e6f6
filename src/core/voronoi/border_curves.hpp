// The curves that borders run along: straight lines, and parabolas (paper, section 3.2).
#pragma once

#include <cstdint>
#include <span>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/kernel/planar_graph_view.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::voronoi {

// [2 b] The control points of the Bezier curves that borders are, on the lattice: where the tangents at their
// ends meet; NaN of straight lines. `ends` and `elements` are two numbers a border, `radius` is the distance of
// each place from its elements.
base::LargeArray<double> control_points(const kernel::PlanarGraphView& graph,
                                        std::span<const std::int64_t> ends,
                                        std::span<const std::int64_t> elements,
                                        std::span<const kernel::Point> places, std::span<const double> radius,
                                        unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::voronoi
