// Offset curves, from segment Voronoi diagrams.
#include <nanobind/stl/vector.h>

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/diagram_arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/offsets/offset_curves.hpp"

namespace vorotool::bindings {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using core::base::Monitor;
using core::offsets::OffsetCurves;
using Indices = Vector<const std::int32_t>;

// What the sites around vertices and the polygons of all parts must be for the core to index by them.
void check(const core::segment_voronoi::build::DiagramView& diagram, const Indices& edge_face,
           const Indices& face_polygon, const Indices& site_polygon) {
  if (diagram.vertex_start.size() != diagram.vertex_count() + 1 || edge_face.size() != diagram.edges.size() ||
      diagram.faces.size() != diagram.segments.size() || site_polygon.size() != diagram.site_count()) {
    throw std::invalid_argument("arrays of a domain do not go with the diagram");
  }
  const auto is_face = [&](std::int32_t face) {
    return face >= 0 && static_cast<std::size_t>(face) < face_polygon.size();
  };
  for (const std::int32_t face : view(edge_face)) {
    if (face >= 0 && !is_face(face)) throw std::invalid_argument("the face of an edge is out of range");
  }
  for (const Pair& pair : diagram.faces) {
    if (!is_face(pair[0]) || !is_face(pair[1]))
      throw std::invalid_argument("the face of a segment is out of range");
  }
}

void check_rings(const Indices& vertex_start, const Indices& vertex_sites) {
  const std::span<const std::int32_t> starts = view(vertex_start);
  for (std::size_t v = 0; v < starts.size(); ++v) {
    const std::int32_t least = v == 0 ? 0 : starts[v - 1];
    if (starts[v] < least || static_cast<std::size_t>(starts[v]) > vertex_sites.size()) {
      throw std::invalid_argument("the sites of a vertex are out of range");
    }
  }
}

Columns as_dict(OffsetCurves&& curves) {
  Columns result;
  result["start"] = two_columns(std::move(curves.start));
  result["end"] = two_columns(std::move(curves.end));
  result["centre"] = two_columns(std::move(curves.centre));
  result["site"] = to_numpy(std::move(curves.site));
  result["ring_start"] = to_numpy(std::move(curves.ring_start));
  result["shape_start"] = to_numpy(std::move(curves.shape_start));
  result["polygon"] = to_numpy(std::move(curves.shape_polygon));
  return result;
}

auto offset_curves(const IndexRows& points, const IndexRows& segments, const Places& vertices,
                   const Vector<const double>& radius, const IndexRows& edges, const IndexRows& edge_sites,
                   const Indices& vertex_start, const Indices& vertex_sites, const Indices& edge_face,
                   const IndexRows& segment_faces, const Indices& face_polygon, const Indices& site_polygon,
                   const Indices& site_feature, const std::vector<double>& distances, double origin_x,
                   double origin_y, double scale, const Progress& progress) {
  const DiagramArrays arrays{points, segments, vertices, radius, edges, edge_sites};
  core::segment_voronoi::build::DiagramView diagram = arrays.diagram();
  diagram.faces = rows<Pair>(segment_faces);
  diagram.vertex_start = view(vertex_start);
  diagram.vertex_sites = view(vertex_sites);
  check(diagram, edge_face, face_polygon, site_polygon);
  if (site_feature.size() != site_polygon.size())
    throw std::invalid_argument("each site must have a feature");
  check_rings(vertex_start, vertex_sites);
  std::vector<OffsetCurves> made = run_interruptible(progress, [&](const Monitor& monitor) {
    const core::offsets::HalfEdges borders(diagram);
    std::vector<OffsetCurves> all;
    for (const double distance : distances) {
      const core::offsets::PolygonFaces domain{view(edge_face), view(face_polygon), view(site_polygon),
                                               view(site_feature), distance > 0};
      all.push_back(core::offsets::offset_curves(borders, domain, std::abs(distance),
                                                 {origin_x, origin_y, scale}, monitor));
    }
    return all;
  });
  std::vector<Columns> result;
  for (OffsetCurves& curves : made) result.push_back(as_dict(std::move(curves)));
  return result;
}

}  // namespace

void bind_offsets(nb::module_& room) {
  room.def("offset_curves", &offset_curves, "points"_a, "segments"_a, "vertices"_a, "radius"_a, "edges"_a,
           "edge_sites"_a, "vertex_start"_a, "vertex_sites"_a, "edge_face"_a, "segment_faces"_a,
           "face_polygon"_a, "site_polygon"_a, "site_feature"_a, "distances"_a, "origin_x"_a, "origin_y"_a,
           "scale"_a, "progress"_a.none(), "Curves at each distance, which is positive outwards.");
}

}  // namespace vorotool::bindings
