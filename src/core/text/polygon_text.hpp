// Polygons and lines as text, in well-known text and in the JSON of two formats.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/kernel/point.hpp"

namespace vorotool::core::text {

enum class PolygonStyle {
  wkt,            // POLYGON ((0 0, 4 0, 0 3, 0 0)), or MULTIPOLYGON
  geojson,        // {"type":"Polygon","coordinates":[[[0,0],[4,0],[0,3],[0,0]]]}, or MultiPolygon
  json,           // "shell":[[0,0],[4,0],[0,3]],"holes":[] of the first polygon: members of an object
  wkt_lines,      // LINESTRING (0 0, 4 0), or MULTILINESTRING: rings are lines, each a polygon of its own
  geojson_lines,  // {"type":"LineString","coordinates":[[0,0],[4,0]]}, or MultiLineString
};

// The polygons of rows. Arrays of beginnings have one entry more than there are, for the end; they must go
// together.
struct PolygonTexts {
  std::span<const kernel::Point> vertices;  // ring after ring, the first of a ring not repeated; finite
  std::span<const std::int64_t> rings;      // where each begins in `vertices`; none is empty
  std::span<const std::int64_t> polygons;   // the first ring, its shell, of each polygon
  std::span<const std::int64_t> rows;       // the first polygon of each row
  PolygonStyle style;

  std::size_t size() const { return rows.size() - 1; }

  // Appends the polygons of a row; coordinates read back the same. Without any, nothing is appended and the
  // result is false; but JSON has an empty shell then. Lines whose vertices all are one place are left out.
  bool append(std::string& out, std::size_t row) const;
};

}  // namespace vorotool::core::text
