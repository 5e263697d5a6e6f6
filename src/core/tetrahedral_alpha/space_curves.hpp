// Measures of the alpha shapes of points in space at all radii.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/indices.hpp"
#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"

namespace vorotool::core::tetrahedral_alpha {

struct SpaceCurveInput {
  std::size_t spectrum, points;  // how many radii, and places of points
  std::span<const std::int32_t> tetrahedron_rank;
  std::span<const base::IndexPair> sides;  // [m] of triangles: tetrahedra, or -1
  std::span<const std::int32_t> triangle_min;
  std::span<const base::IndexPair> edges;  // ends
  std::span<const std::int32_t> edge_min;
  std::span<const double> volume, area;  // of tetrahedra and triangles
};

// [spectrum] of the shape from each radius on: the volume of its tetrahedra, the area of the triangles that bound them,
// its regions (tetrahedra joined through triangles), its parts (all that is joined through edges, single points too),
// and its cavities (bounded components of what is left of space).
struct SpaceCurves {
  base::LargeArray<double> volume, area;
  base::LargeArray<std::int32_t> regions, parts, cavities;
};

SpaceCurves space_curves(const SpaceCurveInput& input, const base::Monitor& monitor);

}  // namespace vorotool::core::tetrahedral_alpha
