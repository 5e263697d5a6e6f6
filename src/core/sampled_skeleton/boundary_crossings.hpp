// Where pieces of edges cross the Voronoi diagram of the seeds, exactly.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/delaunay/vertex_triangles.hpp"
#include "core/sampled_skeleton/sample_labels.hpp"
#include "core/sampled_skeleton/sample_mesh.hpp"

namespace vorotool::core::sampled_skeleton {

// A piece leaves the cell of the origin of a side for that of its target across their Voronoi edge, or the
// other way round.
struct Crossing {
  Side side;
  std::int32_t piece;
  bool from_origin;
};

struct Crossings {
  std::vector<Crossing> crossings;
  std::vector<Side> ridden;       // sides along whose Voronoi edges a piece runs
  std::vector<Triangle> touched;  // triangles with a circumcenter on a piece
};

// Walks along pieces through the cells. Everything is decided exactly, for the pieces as straight lines
// between seeds. A piece that meets no other cells than those of its ends crosses the edge between them only.
Crossings find_crossings(const SampleMesh& mesh, const delaunay::VertexTriangles& rings,
                         const SampleLabels& labels, std::span<const std::int32_t> pieces, unsigned threads,
                         const base::Monitor& monitor);

// The order in which two pieces cross the Voronoi edge of a side, seen along it to the circumcenter of the
// triangle on the left of the side: negative if the first one is farther from that. Pieces that cross it in
// one place, as those do whose seeds are rounded to the same places, have the order of their segments.
int compare_crossings(const SampleMesh& mesh, const SampleLabels& labels, const Crossing& one,
                      const Crossing& other);

}  // namespace vorotool::core::sampled_skeleton
