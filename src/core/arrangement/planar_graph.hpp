// The planar straight-line graph of polygons and open lines on the lattice: what the segment Voronoi diagram
// is made of (paper, section 3.2).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/arrangement/face_polygons.hpp"
#include "core/base/indices.hpp"
#include "core/base/monitor.hpp"
#include "core/kernel/lattice.hpp"

namespace vorotool::core::arrangement {

// How rings are repaired that do not form a planar graph, or whose edges bound no face.
enum class Repair {
  repeated_vertex,  // an edge without length is left out
  touching_vertex,  // a vertex inside an edge cuts it: once a vertex and straight stretch of edges
  crossing,         // edges that cross are cut there, at the nearest lattice point
  moved_edge,       // an edge is led through the centers of cells that it meets: by less than a lattice step
  idle_segment,     // what is no border of any polygon, and of no line, is left out: spikes, overlaps, and
                    // holes without area that lie in no polygon of theirs
  empty_polygon,    // nothing is inside
};
inline constexpr std::size_t repair_kinds = 6;

// How often, and where first: an edge, named by its first vertex (of a polygon, its first vertex), and the
// vertex or other edge that meets it, or -1.
struct RepairCount {
  std::int64_t count = 0;
  std::int32_t edge = -1, other = -1;
};

struct PlanarGraph {
  // Points in the order of the input vertices, then those that are none, sorted.
  std::vector<kernel::LatticePoint> points;  // [n] distinct; every one is used, or the place of a line
  std::vector<std::int32_t> point_vertex;    // [n] the first input vertex there, or -1

  // Segments in the order of the input edges, each directed as its first one runs. No two have both ends in
  // common, none passes through a point, no two cross.
  std::vector<base::IndexPair> segments;  // [m] points
  // Segment s is part of source_edge[source_start[s]] ...
  std::vector<std::int32_t> source_start, source_edge;

  // The faces between the segments. A face lies in the polygons face_polygons.of(face), ascending; face 0 is
  // the unbounded one and lies in none.
  std::vector<base::IndexPair> segment_faces;  // [m] left and right of each segment
  FacePolygons face_polygons;

  // Holes of one place that no segment ends at: [3 h] the point, its face, and the polygon.
  std::vector<std::int32_t> point_holes;

  std::array<RepairCount, repair_kinds> repairs;  // by Repair
  std::vector<std::uint8_t> is_repaired;          // [polygons] whether an edge of it is named by a repair
};

// `vertices` are the vertices of all rings, at most 2^28; edge k goes from vertex k to the next one of its
// ring.
PlanarGraph make_planar_graph(std::span<const kernel::LatticePoint> vertices, const Rings& rings,
                              const base::Monitor& monitor);

}  // namespace vorotool::core::arrangement
