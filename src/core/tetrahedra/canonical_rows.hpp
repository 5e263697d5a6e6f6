// Tetrahedra in their final order.
#pragma once

#include <cstddef>
#include <span>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/tetrahedra/tetrahedral_mesh.hpp"

namespace vorotool::core::tetrahedra {

// The tetrahedra of a mesh, without ghosts and empty slots: the smallest vertex of each first, then the smallest of the
// others, sorted by the first three, which tell the fourth as they tell its side; and their neighbors, -1 outside.
struct CanonicalRows {
  std::size_t count = 0;
  base::LargeArray<Row> vertices, neighbors;
};

// Vertices are replaced by their index. The mesh is used up: there is never a second copy of all of it.
CanonicalRows canonical_rows(TetrahedralMesh& mesh, std::span<const Index> index, unsigned threads,
                             const base::Monitor& monitor);

}  // namespace vorotool::core::tetrahedra
