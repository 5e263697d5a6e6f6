// Which polygons each face of their arrangement lies in.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "core/arrangement/faces.hpp"
#include "core/arrangement/segment_set.hpp"
#include "core/base/monitor.hpp"

namespace vorotool::core::arrangement {

// Polygons nest or overlap so deep that the lists of the faces would not fit.
struct TooManyOverlaps : std::length_error {
  TooManyOverlaps() : std::length_error("the polygons overlap too often") {}
};

enum class RingKind : std::int8_t { shell = 0, hole = 1, line = 2 };

// Rings of polygons: a shell and its holes one after the other; an open line is a polygon of its own.
struct Rings {
  std::span<const std::int64_t> start;    // [r + 1] first vertex
  std::span<const std::int8_t> kind;      // [r] RingKind
  std::span<const std::int32_t> polygon;  // [r] not decreasing

  RingKind kind_of(std::int32_t ring) const {
    return static_cast<RingKind>(kind[static_cast<std::size_t>(ring)]);
  }
};

struct FacePolygons {
  std::vector<std::int32_t> start, polygon;  // face f lies in polygon[start[f]] ...: ascending

  std::span<const std::int32_t> of(std::int32_t face) const {
    const auto f = static_cast<std::size_t>(face);
    return std::span(polygon).subspan(static_cast<std::size_t>(start[f]),
                                      static_cast<std::size_t>(start[f + 1] - start[f]));
  }
};

// A face lies in a polygon if it is inside its shell and in none of its holes, each ring by the even-odd
// rule: crossing a segment changes the side of every ring whose edges it comes from an odd number of times.
// The sources of the segments are edges, `ring_of_edge` the ring of each.
FacePolygons find_face_polygons(const SegmentSet& set, const Faces& faces, const Rings& rings,
                                std::span<const std::int32_t> ring_of_edge, const base::Monitor& monitor);

}  // namespace vorotool::core::arrangement
