// Borders between the places of different sites (paper, section 1): edges of the segment Voronoi diagram of all
// sites together, and segments of its graph.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/segment_voronoi/build/diagram.hpp"

namespace vorotool::core::voronoi {

// Two numbers a border each. A cell of an element, one side of it, or a covered face is a part; what has no
// border between it is one part.
struct SiteBorders {
  base::LargeArray<std::int64_t> ends;      // nodes: vertices of the diagram, then `added`; -1 at infinity
  base::LargeArray<std::int64_t> elements;  // left and right, equally far from it; a wall has itself twice
  base::LargeArray<std::int64_t> parts;     // left and right
  base::LargeArray<std::int64_t> order;     // rising counter-clockwise around the source, and the target
  base::LargeArray<std::int32_t> sites;     // left and right
  std::vector<std::int32_t> added;          // points in the middle of straight lines that borders end in

  // What is needed to go on with a limit of distance; empty without one.
  std::vector<std::int32_t> edge;      // of each border that is one of the diagram: these come first
  std::vector<std::int32_t> point;     // that it is a half of the edge up to, or -1
  std::vector<std::uint8_t> is_first;  // whether it is the half towards the source
  std::vector<std::int32_t> root;      // of points, left and right sides of segments, faces: their part

  std::size_t size() const { return sites.size() / 2; }
};

// How far borders reach.
struct Reach {
  std::span<const std::uint8_t> is_near;  // [e] whether an edge is within a limit at all
  std::span<const std::int32_t> crowded;  // vertices at which what runs along the limit ends as well
};

// In which face of the graph each edge is towards its source, and towards its target; whether it is between a segment
// and its own end.
struct EdgeFaces {
  base::LargeArray<std::int32_t> faces;   // [2 e]
  base::LargeArray<std::uint8_t> is_own;  // [e]
  std::vector<std::int32_t> alias;        // [n] as of `OwnEnds`
};
EdgeFaces edge_faces(const segment_voronoi::build::DiagramView& diagram, unsigned threads,
                     const base::Monitor& monitor);

// Of an owner of each element of the diagram's graph, and of each of its faces: -1 of those that no site
// covers. Vertices in covered faces may be left out of the diagram.
//
// Nothing is decided by coordinates but whether a point is on a straight line between two others.
//
// Throws std::invalid_argument or std::runtime_error if the diagram is none.
SiteBorders site_borders(const segment_voronoi::build::DiagramView& diagram,
                         std::span<const std::int32_t> element_owner,
                         std::span<const std::int32_t> face_owner, const std::optional<Reach>& reach,
                         unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::voronoi
