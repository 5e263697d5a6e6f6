// Offset curves, from segment Voronoi diagrams.
#include <nanobind/stl/vector.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/segment_diagram.hpp"
#include "core/offsets/level_map.hpp"
#include "core/offsets/offset_curves.hpp"

namespace vorotool::bindings {
namespace {

using core::base::Monitor;
using core::offsets::LevelMap;
using core::offsets::OffsetCurves;

void check_faces(const core::segment_voronoi::build::DiagramView& diagram, const Indices& edge_face,
                 const Indices& face_polygon) {
  if (edge_face.size() != diagram.edges.size()) {
    throw std::invalid_argument("faces of edges do not go with the diagram");
  }
  const std::size_t faces = face_polygon.size();
  core::base::check_range(view(edge_face), -1, faces, "the face of an edge is out of range");
  core::base::check_range(diagram.faces, 0, faces, "the face of a segment is out of range");
}

// What the polygons of all parts must be for the core to index by them.
void check(const core::segment_voronoi::build::DiagramView& diagram, const Indices& edge_face,
           const Indices& face_polygon, const Indices& site_polygon, const Indices& site_feature) {
  if (site_polygon.size() != diagram.site_count() || site_feature.size() != diagram.site_count()) {
    throw std::invalid_argument("arrays of a domain do not go with the diagram");
  }
  check_faces(diagram, edge_face, face_polygon);
}

Columns curves_as_dict(OffsetCurves&& curves) {
  Columns result;
  result["start"] = two_columns(std::move(curves.start));
  result["end"] = two_columns(std::move(curves.end));
  result["center"] = two_columns(std::move(curves.center));
  result["site"] = to_numpy(std::move(curves.site));
  result["ring_starts"] = to_numpy(std::move(curves.ring_start));
  result["shape_starts"] = to_numpy(std::move(curves.shape_start));
  result["polygon"] = to_numpy(std::move(curves.shape_polygon));
  return result;
}

auto offset_curves(const SegmentDiagram& input, const Indices& edge_face, const Indices& face_polygon,
                   const Indices& site_polygon, const Indices& site_feature,
                   const std::vector<double>& distances, double origin_x, double origin_y, double scale,
                   const Progress& progress) {
  const core::segment_voronoi::build::DiagramView& diagram = input.view_with_faces();
  check(diagram, edge_face, face_polygon, site_polygon, site_feature);
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
  for (OffsetCurves& curves : made) result.push_back(curves_as_dict(std::move(curves)));
  return result;
}

Columns level_crossings(const SegmentDiagram& input, const Indices& edge_face, const Indices& face_polygon,
                        double level, const Progress& progress) {
  const core::segment_voronoi::build::DiagramView& diagram = input.view_with_faces();
  const std::vector<std::int32_t> of_sites(diagram.site_count(), -1);
  check_faces(diagram, edge_face, face_polygon);
  LevelMap made = run_interruptible(progress, [&](const Monitor& monitor) {
    const core::offsets::PolygonFaces domain{view(edge_face), view(face_polygon), of_sites, of_sites, true};
    return core::offsets::level_map(core::offsets::HalfEdges(diagram), domain, level, monitor);
  });
  Columns result;
  result["half_edge"] = to_numpy(std::move(made.half_edge));
  result["across"] = to_numpy(std::move(made.across));
  result["ending"] = to_numpy(std::move(made.ending));
  result["arc"] = to_numpy(std::move(made.arc));
  result["place"] = two_columns(std::move(made.place));
  result["middle"] = two_columns(std::move(made.middle));
  result["circles"] = to_numpy(std::move(made.circles));
  return result;
}

}  // namespace

void bind_offsets(nb::module_& room) {
  room.def("offset_curves", &offset_curves, "diagram"_a, "edge_face"_a, "face_polygon"_a, "site_polygon"_a,
           "site_feature"_a, "distances"_a, "origin_x"_a, "origin_y"_a, "scale"_a, "progress"_a.none(),
           "Curves at each distance, which is positive outwards.");
  room.def(
      "level_crossings", &level_crossings, "diagram"_a, "edge_face"_a, "face_polygon"_a, "level"_a,
      "progress"_a.none(),
      "Where curves at a distance from all sites, in lattice units, cross edges of their diagram, and how "
      "they go on from there.");
}

}  // namespace vorotool::bindings
