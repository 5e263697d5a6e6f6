// Radii of several tetrahedra, triangles or edges at once, by the estimates of simplex_radius.cpp; what they leave in doubt is
// said.
//
// The files of the kernels are compiled for wider instruction sets than the rest. They take raw pointers and call
// nothing from the standard library, so that no inline function compiled for a wide machine is linked elsewhere.
#pragma once

#include "core/tetrahedra/point3.hpp"

namespace vorotool::core::tetrahedral_alpha {

using tetrahedra::Point3;

// What is known of a tetrahedron: TetrahedronMeasure, its sides above its facets, and whether all of it is certain.
inline constexpr unsigned first_side_bit = 4, certain_bit = 1U << 10;

struct RadiusBatch {
  static constexpr int group = 4;

  // Of `group` tetrahedra, each with the numbers of its corners: radii, and the bits above.
  void (*tetrahedra)(const Point3* points, const int (*corners)[4], bool are_integers, double* radius,
                     unsigned short* known);

  // Of `group` triangles or edges: radii, and whether they are certain in bit k for that of simplex k.
  unsigned (*triangles)(const Point3* points, const int (*corners)[3], double* radius);
  unsigned (*edges)(const Point3* points, const int (*corners)[2], double* radius);
};

// That for the widest vectors of this machine.
RadiusBatch radius_batch();

namespace kernels {
RadiusBatch radii_portable();
RadiusBatch radii_avx2();
}  // namespace kernels

}  // namespace vorotool::core::tetrahedral_alpha
