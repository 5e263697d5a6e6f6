// The filter of in_sphere for several tetrahedra and one point.
//
// The files of the kernels are compiled for wider instruction sets than the rest. They take raw pointers and call
// nothing from the standard library, so that no inline function compiled for a wide machine is linked elsewhere.
#pragma once

#include "core/tetrahedra/point3.hpp"

namespace vorotool::core::tetrahedra {

// Bounds of the error of the determinant: one for all points of a set; and, times x y z (x^2 + y^2 + z^2) + guard, where
// no differences are larger than x, y, z along the axes, one of a call.
struct SphereBound {
  double all;
  double factor, guard;

  double of(double x, double y, double z) const {
    return factor * (x * y * z * (x * x + y * y + z * z) + guard);
  }
};

// Bit k is that of tetrahedron k: whether the sphere certainly holds the point, and whether it certainly does not.
struct SphereSides {
  unsigned inside, outside;
};

// The numbers of the vertices of four positive tetrahedra, and all points.
using SphereBatch = SphereSides (*)(const Point3* points, const int* const (&tetrahedra)[4], const Point3& p,
                                    const SphereBound& bound);

// That for the widest vectors of this machine.
SphereBatch sphere_batch();

namespace kernels {
SphereBatch spheres_portable();
SphereBatch spheres_avx2();
}  // namespace kernels

}  // namespace vorotool::core::tetrahedra
