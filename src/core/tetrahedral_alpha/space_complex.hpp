// The alpha complex of a Delaunay triangulation of points in space: for each tetrahedron, triangle and edge the radii at
// which it enters the alpha shape, bounds a tetrahedron of it, and goes inside.
//
//   tetrahedron  its circumradius, all three
//   triangle     r_min = its own circumradius, if neither opposite corner is strictly inside its smallest sphere (it is
//                a Gabriel triangle), else r_mid; r_mid and r_max = the least and the greatest radius of its tetrahedra
//   edge         r_min = half its length, if no corner opposite to it is strictly inside the sphere on it as diameter,
//                else the least r_min of its triangles; r_mid and r_max = the least and the greatest radius of its
//                tetrahedra
//
// r_max is infinite on the hull, r_mid too where there is no tetrahedron. Only corners of tetrahedra around a simplex
// need a look: if there is any point inside its smallest sphere, one of these is.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/tetrahedra/point3.hpp"
#include "core/tetrahedral_alpha/edge_stars.hpp"
#include "core/tetrahedral_alpha/facets.hpp"

namespace vorotool::core::tetrahedral_alpha {

using Corners = std::array<std::int32_t, 3>;

// Of points that are not in one plane tetrahedra, positive, with the neighbors opposite to their corners, -1 outside; of
// others triangles; of points on a line edges.
struct SpaceInput {
  std::span<const tetrahedra::Point3> points;  // finite
  std::span<const Row> tetrahedra, neighbors;
  std::span<const Corners> triangles;
  std::span<const Ends> edges;
};

// The spectrum holds the radii at which shapes change, each exact value once, in increasing order; ranks are places in
// it, and an infinite radius has the rank behind the last. Its doubles do not decrease, and are within 2^-40 of the
// exact ones, nearly all within 2^-50.
struct SpaceArrays {
  base::LargeArray<std::int32_t> tetrahedron_rank;  // [t]
  // [m] 4 t + k of each triangle: of a tetrahedron the facet opposite to a corner. None where the input has triangles.
  base::LargeArray<std::int32_t> facet;
  base::LargeArray<std::int32_t> triangle_min;                  // [m]
  base::LargeArray<Ends> edges;                                 // [e] the smaller index first
  base::LargeArray<std::int32_t> edge_min, edge_mid, edge_max;  // [e]
  base::LargeArray<double> spectrum;                            // [s]
  base::LargeArray<std::int32_t>
      witness;  // [s] a tetrahedron, t + a triangle or t + m + an edge of this radius
};

SpaceArrays space_complex(const SpaceInput& input, unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::tetrahedral_alpha
