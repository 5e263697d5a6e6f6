// A segment Voronoi diagram in flat arrays: as it is made, and as what follows from it reads them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/indices.hpp"
#include "core/base/large_array.hpp"
#include "core/kernel/planar_graph_view.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::segment_voronoi::build {

// Sites have the numbers of the graph that it is the diagram of, coordinates are those of its lattice.
struct DiagramView : kernel::PlanarGraphView {
  std::span<const kernel::Point> vertices;      // [v]
  std::span<const double> radius;               // [v] 0 at a corner of segments, and only there
  std::span<const base::IndexPair> edges;       // [e] source and target, -1 at infinity
  std::span<const base::IndexPair> edge_sites;  // [e] left and right, from source to target
  // All sites that the disc of a vertex touches and whose cells meet there, counter-clockwise from the
  // smallest number. Empty where they are not looked at.
  std::span<const std::int32_t> vertex_start;  // [v + 1] into vertex_sites
  std::span<const std::int32_t> vertex_sites;

  std::size_t vertex_count() const { return radius.size(); }
  std::span<const std::int32_t> ring(std::size_t vertex) const {
    const std::size_t start = base::at(vertex_start[vertex]);
    return vertex_sites.subspan(start, base::at(vertex_start[vertex + 1]) - start);
  }
};

// The same without the graph. What comes first is decided by the order in which the engine works on the
// sites, that of a curve through the points: it depends on where they are, not on how they are numbered.
struct Diagram {
  base::LargeArray<double> vertices;  // [2 v] in the order of the lists of their sites
  base::LargeArray<double> radius;
  base::LargeArray<std::int32_t> vertex_start, vertex_sites;
  // [2 e] As source, infinity is only that of edges without a vertex. These come first; the others with
  // their source, the end with the smaller number, counter-clockwise around it.
  base::LargeArray<std::int32_t> edges, edge_sites;
};

}  // namespace vorotool::core::segment_voronoi::build
