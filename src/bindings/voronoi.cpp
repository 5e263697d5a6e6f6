// Borders between sites of points, lines and polygons.
#include <stdexcept>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/segment_diagram.hpp"
#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/voronoi/site_borders.hpp"

namespace vorotool::bindings {
namespace {

Columns site_borders(const SegmentDiagram& input, const Indices& element_owner, const Indices& face_owner,
                     unsigned threads, const Progress& progress) {
  const core::segment_voronoi::build::DiagramView& diagram = input.view_with_faces();
  if (element_owner.size() != diagram.site_count())
    throw std::invalid_argument("each element must have an owner");
  core::base::check_range(diagram.faces, 0, face_owner.size(), "the face of a segment is out of range");
  if (face_owner.size() == 0) throw std::invalid_argument("the unbounded face must have an owner");
  core::voronoi::SiteBorders made =
      run_interruptible(progress, core::voronoi::site_borders, diagram, view(element_owner), view(face_owner),
                        core::base::resolve_threads(threads));
  const std::size_t size = made.size();
  Columns result;
  result["ends"] = to_numpy(std::move(made.ends), {size, 2});
  result["elements"] = to_numpy(std::move(made.elements), {size, 2});
  result["sites"] = to_numpy(std::move(made.sites), {size, 2});
  result["parts"] = to_numpy(std::move(made.parts), {size, 2});
  result["order"] = to_numpy(std::move(made.order), {size, 2});
  result["added"] = to_numpy(std::move(made.added));
  return result;
}

}  // namespace

void bind_voronoi(nb::module_& room) {
  room.def(
      "site_borders", &site_borders, "diagram"_a, "element_owner"_a, "face_owner"_a, "threads"_a,
      "progress"_a.none(),
      "Ends, elements, sites, parts and order of borders, and the points that became nodes after vertices.");
}

}  // namespace vorotool::bindings
