// Insertion of points into a Delaunay triangulation, where they lie: the property for which the paper chose
// the incremental algorithm of Ohya, Iri and Murota (1984).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/delaunay/triangulation.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::delaunay {

// The arrays of a triangulation, as in TriangulationArrays.
struct InsertedArrays {
  base::LargeArray<std::int32_t> triangles, neighbors, edges;
  std::vector<std::int32_t> hull, first;
};

// The triangulation of `points`, of which the first ones are those of `mesh`, which DelaunayTriangulation or
// this function has made: array by array what DelaunayTriangulation makes of all of them. `hints` may hold
// for each further point one of `mesh` from which the search for it begins; without it, the order of the
// triangles tells where to begin.
//
// m points take time O(m log n) if a constant number of triangles each is expected to change, and the copying
// of the arrays besides. There is no result where triangles that stay may change their order: with a point
// outside the bounds of `mesh`, or more than two points in one cell of the order's grid near a change; nor
// where `mesh` has no triangles. Throws std::invalid_argument where `mesh` is found not to be a
// triangulation.
std::optional<InsertedArrays> insert_points(const TriangulationArrays& mesh,
                                            std::span<const kernel::Point> points,
                                            std::span<const std::int32_t> hints, unsigned threads,
                                            const base::Monitor& monitor);

}  // namespace vorotool::core::delaunay
