// Measures of tetrahedra and cells of space from integers: right for all finite doubles, and slow.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/tetrahedra/point3.hpp"

namespace vorotool::core::tetrahedra {

// The sphere through the corners of a tetrahedron.
struct Sphere {
  Point3 way;     // from the first corner to the center
  double error;   // at most, of the way: a distance
  double volume;  // of the tetrahedron
};

// The doubles nearest to the exact values, infinite beyond the largest. The tetrahedron is not flat.
Sphere exact_sphere(const std::array<Point3, 4>& corners);

// The sign of |q - a| - |q - b|: -1 if a is nearer to q, 1 if b is, 0 if they are equally near.
int compare_distances(const Point3& q, const Point3& a, const Point3& b);

// A face of two tetrahedra at a site, between whose centers an edge of the site's cell goes. The tetrahedra have
// numbers among those at the site; the first has its site, b and c counter-clockwise as seen from its fourth corner.
struct CellEdge {
  std::uint32_t first, second;
  Point3 b, c;
};

// The volume of the Voronoi cell of a site that is not on the hull, within 2^-50 of itself. `ends` has the three other
// corners of each tetrahedron at the site, which are a positive tetrahedron with it.
double exact_cell_volume(const Point3& site, std::span<const std::array<Point3, 3>> ends,
                         std::span<const CellEdge> edges);

}  // namespace vorotool::core::tetrahedra
