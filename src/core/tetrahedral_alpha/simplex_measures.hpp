// Radii of many tetrahedra, triangles or edges.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/tetrahedral_alpha/scaled_points.hpp"
#include "core/tetrahedral_alpha/simplex_radius.hpp"

namespace vorotool::core::tetrahedral_alpha {

// A number for each tetrahedron, as TetrahedronMeasure has them.
struct TetrahedronMeasures {
  double* radius;
  std::uint8_t *cut, *cut_sides;
};
void measure_tetrahedra(const ScaledPoints& points, std::span<const std::array<std::int32_t, 4>> corners,
                        const TetrahedronMeasures& out);

// A number for each triangle (3) or edge (2): ranked_radius.
template <std::size_t size>
void measure_simplices(const ScaledPoints& points, std::span<const std::array<std::int32_t, size>> corners,
                       double* radius);

}  // namespace vorotool::core::tetrahedral_alpha
