// Offset curves, from segment Voronoi diagrams.
#include <nanobind/stl/vector.h>

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/segment_diagram.hpp"
#include "core/offsets/offset_curves.hpp"

namespace vorotool::bindings {
namespace {

using core::base::Monitor;
using core::offsets::OffsetCurves;

// What the polygons of all parts must be for the core to index by them.
void check(const core::segment_voronoi::build::DiagramView& diagram, const Indices& edge_face,
           const Indices& face_polygon, const Indices& site_polygon, const Indices& site_feature) {
  if (edge_face.size() != diagram.edges.size() || site_polygon.size() != diagram.site_count() ||
      site_feature.size() != diagram.site_count()) {
    throw std::invalid_argument("arrays of a domain do not go with the diagram");
  }
  const std::size_t faces = face_polygon.size();
  core::base::check_range(view(edge_face), -1, faces, "the face of an edge is out of range");
  core::base::check_range(diagram.faces, 0, faces, "the face of a segment is out of range");
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
  for (OffsetCurves& curves : made) result.push_back(as_dict(std::move(curves)));
  return result;
}

}  // namespace

void bind_offsets(nb::module_& room) {
  room.def("offset_curves", &offset_curves, "diagram"_a, "edge_face"_a, "face_polygon"_a, "site_polygon"_a,
           "site_feature"_a, "distances"_a, "origin_x"_a, "origin_y"_a, "scale"_a, "progress"_a.none(),
           "Curves at each distance, which is positive outwards.");
}

}  // namespace vorotool::bindings
