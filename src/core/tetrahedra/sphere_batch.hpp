// The filter of in_sphere for several tetrahedra and one point.
//
// The files of the kernels are compiled for wider instruction sets than the rest. They take raw pointers and call
// nothing from the standard library, so that no inline function compiled for a wide machine is linked elsewhere.
#pragma once

#include "core/tetrahedra/point3.hpp"

namespace vorotool::core::tetrahedra {

// Bounds of the error of the determinant: one for all points of a set; and, times x y z (x^2 + y^2 + z^2) + guard,
// where no differences are larger than x, y, z along the axes, one of a call. Where x y z (x^2 + y^2 + z^2) is below
// the last number there is no error: that is 0 unless all coordinates are integers.
struct SphereBound {
  double all;
  double factor, guard;
  double exact;

  // Where differences are below this and exact, the keys of kernels are in lexicographic order.
  static constexpr double largest_key = 0x1p11;

  static double product(double x, double y, double z) { return x * y * z * (x * x + y * y + z * z); }
  double of(double product) const { return factor * (product + guard); }
};

// Bit k is that of tetrahedron k: whether the sphere certainly holds the point, and whether it certainly does not,
// ties broken.
struct SphereSides {
  unsigned inside, outside;

  bool are_all(int tetrahedra) const { return (inside | outside) + 1 == 1U << tetrahedra; }
  void add(const SphereSides& more) { inside |= more.inside, outside |= more.outside; }
};

// Four tetrahedra of an array that has the numbers of their vertices at the front of records of eight, each by a facet,
// 4 times its number and up to 3 more. Of one that has a vertex with coordinates that are NaN nothing is certain.
using SphereBatch = SphereSides (*)(const Point3* points, const int (*records)[8], const int* facets,
                                    const Point3& p, const SphereBound& bound);

// That for the widest vectors of this machine.
SphereBatch sphere_batch();

namespace kernels {
SphereBatch spheres_portable();
SphereBatch spheres_avx2();
}  // namespace kernels

}  // namespace vorotool::core::tetrahedra
