// An exact check of a Delaunay triangulation of space that knows its arrays only, not how they were made.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/fault.hpp"
#include "core/base/monitor.hpp"
#include "core/tetrahedra/point3.hpp"

namespace vorotool::core::tetrahedra {

struct TetrahedraView {
  std::span<const Point3> points;
  std::span<const std::array<std::int32_t, 4>> vertices, neighbors;
  std::span<const std::int32_t> first;
};

// What is wrong, in words: the first fault of the first check that fails. Nothing if the arrays are the Delaunay
// triangulation of the points, with polytopes of cospherical points divided by pulling their vertices in lexicographic
// order; or if there are no tetrahedra, and the points are coplanar.
base::Fault find_fault(const TetrahedraView& arrays, unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::tetrahedra
