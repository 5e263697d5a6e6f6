// Certified bounds of the errors of arcs: how far any of their points is from the exact skeleton.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"
#include "core/sampled_skeleton/arc_error_bound.hpp"
#include "core/sampled_skeleton/sample_diagram.hpp"

namespace vorotool::core::sampled_skeleton {

// A straight arc on the lattice: a part of the Voronoi edge of a side, or a line that completes the skeleton.
struct BoundedArc {
  std::array<kernel::Point, 2> place;  // source and target
  Side side;          // of a line that completes: one whose triangles the disc about its target meets; -1: no
                      // triangles
  std::int32_t seed;  // on one side of it
  std::int32_t corner;  // where a line that completes begins, its source; else -1
};

struct ErrorBound {
  double error = 0;                    // lattice steps; infinite where nothing is proved
  std::array<double, 2> radius{0, 0};  // clearance at the ends; where very many edges are near, not quite
};

// Arcs by index, and the callback that receives each bound. Both are called on several threads.
struct ArcsToBound {
  std::size_t count;
  std::function<BoundedArc(std::size_t)> arc;
  std::function<void(std::size_t, const ErrorBound&)> take;
};

// `parts`, if not empty, says for each piece of an edge how many parts it should have for errors of at most
// `tolerance`: at least what stands there already.
void bound_arcs(const SampleDiagram& diagram, const ArcsToBound& arcs, double tolerance,
                std::span<std::int32_t> parts, unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::sampled_skeleton
