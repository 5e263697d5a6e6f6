// Graphs of points that are near to each other: subgraphs of their Delaunay triangulation.
//
// The Gabriel graph has an edge where no other point is in the closed disc with the edge as diameter (Gabriel
// and Sokal 1969); the relative neighborhood graph where no point is nearer to both ends than these are to
// each other (Toussaint 1980); the minimum spanning tree joins all points by edges of the least total length.
// Each is part of the one before. They are graphs of the points alone: an edge that only some of the Delaunay
// triangulations have is a diagonal of cocircular points, of which one is on or inside the disc over it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/delaunay/triangulation.hpp"

namespace vorotool::core::proximity {

enum class ProximityKind : std::uint8_t { gabriel, relative, spanning_tree };

// Places of the edges of a Delaunay triangulation that are in the graph, increasing. Every decision is exact;
// of equal lengths in the tree the edge that comes first is taken first. Throws std::invalid_argument for
// indices that do not exist or do not go together.
std::vector<std::int32_t> proximity_edges(const delaunay::TriangulationArrays& mesh, ProximityKind kind,
                                          unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::proximity
