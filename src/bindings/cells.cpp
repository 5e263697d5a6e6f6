// Voronoi cells of a triangulation, and what is computed of them.
#include <nanobind/stl/array.h>

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/triangulation.hpp"
#include "core/cells/cell_measures.hpp"
#include "core/cells/verify_cells.hpp"
#include "core/cells/voronoi_cells.hpp"

namespace vorotool::bindings {
namespace {

// Vertices of the rings, and where each ring starts.
auto voronoi_cells(const Triangulation& mesh, const std::array<double, 4>& frame, unsigned threads,
                   const Progress& progress) {
  const core::cells::Box box{frame[0], frame[1], frame[2], frame[3]};
  core::cells::VoronoiCells cells =
      run_interruptible(progress, core::cells::voronoi_cells, mesh.view(), box, threads);
  return std::make_tuple(points_to_numpy(std::move(cells.vertices)), to_numpy(std::move(cells.starts)));
}

std::optional<std::string> find_cell_fault(const Places& sites, const Places& vertices,
                                           const Vector<const std::int64_t>& starts,
                                           const std::array<double, 4>& frame, unsigned threads,
                                           const Progress& progress) {
  const core::cells::CellRings cells{rows<core::kernel::Point>(sites), rows<core::kernel::Point>(vertices),
                                     view(starts)};
  if (cells.starts.size() != cells.sites.size() + 1)
    throw std::invalid_argument("there must be one ring a site");
  const core::cells::Box box{frame[0], frame[1], frame[2], frame[3]};
  return run_interruptible(progress, core::cells::find_cell_fault, cells, box, threads);
}

// Area, perimeter, distance of the farthest vertex, and whether one is on the frame.
auto measure_cells(const Places& sites, const Places& vertices, const Vector<const std::int64_t>& rings,
                   const Vector<const std::int64_t>& cell_rings, const std::array<double, 4>& frame,
                   unsigned threads, const Progress& progress) {
  const core::cells::CellOutlines cells{rows<core::kernel::Point>(sites), rows<core::kernel::Point>(vertices),
                                        view(rings), view(cell_rings)};
  if (cells.cell_rings.size() != cells.sites.size() + 1)
    throw std::invalid_argument("there must be one cell a site");
  const core::cells::Box box{frame[0], frame[1], frame[2], frame[3]};
  core::cells::CellMeasures measures =
      run_interruptible(progress, core::cells::measure_cells, cells, box, threads);
  return std::make_tuple(to_numpy(std::move(measures.area)), to_numpy(std::move(measures.perimeter)),
                         to_numpy(std::move(measures.reach)), to_numpy(std::move(measures.touches_frame)));
}

}  // namespace

void bind_cells(nb::module_& room) {
  room.def("voronoi_cells", &voronoi_cells, "mesh"_a, "frame"_a, "threads"_a, "progress"_a.none(),
           "Vertices of the cells' rings, and where the ring of each point begins.");
  room.def("find_cell_fault", &find_cell_fault, "sites"_a, "vertices"_a, "starts"_a, "frame"_a, "threads"_a,
           "progress"_a.none());
  room.def(
      "measure_cells", &measure_cells, "sites"_a, "vertices"_a, "rings"_a, "cell_rings"_a, "frame"_a,
      "threads"_a, "progress"_a.none(),
      "Area, perimeter, distance of the farthest vertex from the site, whether a vertex is on the frame.");
}

}  // namespace vorotool::bindings
