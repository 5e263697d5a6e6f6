// The polygons whose boundary a segment Voronoi diagram was built from, as faces of the plane.
#pragma once

#include <cstdint>
#include <span>

#include "core/offsets/level_set.hpp"

namespace vorotool::core::offsets {

struct PolygonFaces {
  std::span<const std::int32_t> edge_face;     // [e] -1 between a segment and its own end
  std::span<const std::int32_t> face_polygon;  // [f] the first one, -1 outside
  std::span<const std::int32_t> site_polygon;  // [n + m] the first one
  std::span<const std::int32_t> site_feature;  // [n + m] of which that is a part
  bool is_outward;                             // of the polygons: towards faces outside

  bool is_own_end(HalfEdge h) const { return edge_face[static_cast<std::size_t>(h >> 1)] < 0; }
  // Whether a half-edge begins in a face that the curves are in.
  bool holds(const HalfEdges& borders, HalfEdge h) const {
    return (polygon_at(borders, h) < 0) == is_outward;
  }
  // The polygon where a half-edge begins, -1 outside.
  std::int32_t polygon_at(const HalfEdges& borders, HalfEdge h) const {
    return face_polygon[static_cast<std::size_t>(face_at(borders, h))];
  }

 private:
  std::int32_t face_at(const HalfEdges& borders, HalfEdge h) const {
    if (!is_own_end(h)) return edge_face[static_cast<std::size_t>(h >> 1)];
    const segment_voronoi::build::DiagramView& diagram = borders.diagram();
    const std::int32_t left = borders.left(h), right = borders.right(h);
    const bool is_left = begins_left(diagram.site(left), diagram.site(right));
    return diagram.faces[diagram.segment_of(diagram.is_point(left) ? right : left)][is_left ? 0 : 1];
  }
};

}  // namespace vorotool::core::offsets
