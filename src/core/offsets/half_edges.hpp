// The borders of the cells of a segment Voronoi diagram, gone round half-edge by half-edge.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/segment_voronoi/build/diagram.hpp"
#include "core/skeleton/bisector_arc.hpp"

namespace vorotool::core::offsets {

using HalfEdge = std::int32_t;
inline constexpr HalfEdge no_edge = -1;

// Half-edge 2k leads from the source of edge k to its target, 2k + 1 back. The cell of the site on the left
// of a half-edge is gone round counter-clockwise; one that is unbounded is closed at infinity.
class HalfEdges {
 public:
  // Throws std::invalid_argument if the sites around vertices do not fit the edges.
  explicit HalfEdges(const segment_voronoi::build::DiagramView& diagram);

  const segment_voronoi::build::DiagramView& diagram() const { return diagram_; }
  HalfEdge size() const { return static_cast<HalfEdge>(2 * diagram_.edges.size()); }

  // Ends, -1 at infinity.
  std::int32_t tail(HalfEdge h) const { return edge_end(h, 0); }
  std::int32_t head(HalfEdge h) const { return edge_end(h, 1); }
  std::int32_t left(HalfEdge h) const { return edge_site(h, 0); }
  std::int32_t right(HalfEdge h) const { return edge_site(h, 1); }

  // The half-edge after this one around the cell on its left.
  HalfEdge next(HalfEdge h) const {
    return head(h) >= 0 ? leaving_[slot(head(h), left(h))] : from_infinity(h);
  }

  // Half-edges that leave a vertex follow each other counter-clockwise by this number.
  std::size_t rank_at_tail(HalfEdge h) const { return slot(tail(h), left(h)); }

  // The way along the bisector of two points, or of a segment and its end, which alone are unbounded: across
  // the line between their middles, the left site to the left; twice as long as these are apart.
  kernel::Point way(HalfEdge h) const;

 private:
  std::int32_t edge_end(HalfEdge h, int end) const {
    return diagram_.edges[static_cast<std::size_t>(h >> 1)][static_cast<std::size_t>((h & 1) ^ end)];
  }
  std::int32_t edge_site(HalfEdge h, int hand) const {
    return diagram_.edge_sites[static_cast<std::size_t>(h >> 1)][static_cast<std::size_t>((h & 1) ^ hand)];
  }

  std::size_t slot(std::int32_t vertex, std::int32_t site) const;
  HalfEdge from_infinity(HalfEdge h) const;

  segment_voronoi::build::DiagramView diagram_;
  base::LargeArray<HalfEdge> leaving_;  // as vertex_sites: what leaves the vertex with this site on its left
  std::vector<std::pair<std::int32_t, HalfEdge>> infinite_;  // what comes from infinity, by the left site
};

}  // namespace vorotool::core::offsets
