// Voronoi cells of a triangulation, and what is computed of them.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <array>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "core/cells/cell_measures.hpp"
#include "core/cells/verify_cells.hpp"
#include "core/cells/voronoi_cells.hpp"
#include "core/delaunay/nearest_neighbours.hpp"
#include "interrupts.hpp"
#include "mesh_arrays.hpp"

namespace vorotool::bindings {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using core::base::Monitor;

// Vertices of the rings, and where each ring starts.
nb::tuple voronoi_cells(const Matrix<const double>& points, const IndexRows& triangles,
                        const IndexRows& neighbours, const Indices& hull, const Indices& first,
                        const std::array<double, 4>& frame, unsigned threads, nb::handle progress) {
  const core::delaunay::TriangulationArrays mesh =
      mesh_arrays(points, triangles, neighbours, {}, view(hull), view(first));
  const core::cells::Box box{frame[0], frame[1], frame[2], frame[3]};
  core::cells::VoronoiCells cells = run_interruptible(progress, [&](const Monitor& monitor) {
    return core::cells::voronoi_cells(mesh, box, threads, monitor);
  });
  return nb::make_tuple(points_to_numpy(std::move(cells.vertices)), to_numpy(std::move(cells.starts)));
}

std::optional<std::string> cell_fault(const Matrix<const double>& sites, const Matrix<const double>& vertices,
                                      const Vector<const std::int64_t>& starts,
                                      const std::array<double, 4>& frame, unsigned threads,
                                      nb::handle progress) {
  const core::cells::CellRings cells{as_points(sites), as_points(vertices), view(starts)};
  if (cells.starts.size() != cells.sites.size() + 1)
    throw std::invalid_argument("there must be one ring a site");
  const core::cells::Box box{frame[0], frame[1], frame[2], frame[3]};
  return run_interruptible(progress, [&](const Monitor& monitor) {
    return core::cells::find_cell_fault(cells, box, threads, monitor);
  });
}

// The nearest point of each, and its number of neighbours.
nb::tuple nearest_neighbours(const Matrix<const double>& points, const IndexRows& edges,
                             const Vector<const std::int64_t>& labels, nb::handle progress) {
  const std::span<const core::kernel::Point> sites = as_points(points);
  const std::span<const std::int32_t> ends = rows_of(edges, 2);
  if (labels.size() != sites.size()) throw std::invalid_argument("there must be one label a point");
  core::delaunay::NearestNeighbours found = run_interruptible(progress, [&](const Monitor& monitor) {
    return core::delaunay::nearest_neighbours(sites, ends, view(labels), monitor);
  });
  return nb::make_tuple(to_numpy(std::move(found.nearest)), to_numpy(std::move(found.count)));
}

// Area, perimeter, distance of the farthest vertex, and whether one is on the frame.
nb::tuple measure_cells(const Matrix<const double>& sites, const Matrix<const double>& vertices,
                        const Vector<const std::int64_t>& rings, const Vector<const std::int64_t>& cell_rings,
                        const std::array<double, 4>& frame, unsigned threads, nb::handle progress) {
  const core::cells::CellOutlines cells{as_points(sites), as_points(vertices), view(rings), view(cell_rings)};
  if (cells.cell_rings.size() != cells.sites.size() + 1)
    throw std::invalid_argument("there must be one cell a site");
  const core::cells::Box box{frame[0], frame[1], frame[2], frame[3]};
  core::cells::CellMeasures measures = run_interruptible(progress, [&](const Monitor& monitor) {
    return core::cells::measure_cells(cells, box, threads, monitor);
  });
  return nb::make_tuple(to_numpy(std::move(measures.area)), to_numpy(std::move(measures.perimeter)),
                        to_numpy(std::move(measures.reach)), to_numpy(std::move(measures.touches_frame)));
}

}  // namespace

void bind_cells(nb::module_& module) {
  module.def("voronoi_cells", &voronoi_cells, "points"_a.noconvert(), "triangles"_a.noconvert(),
             "neighbours"_a.noconvert(), "hull"_a.noconvert(), "first"_a.noconvert(), "frame"_a, "threads"_a,
             "progress"_a.none());
  module.def("cell_fault", &cell_fault, "sites"_a.noconvert(), "vertices"_a.noconvert(),
             "starts"_a.noconvert(), "frame"_a, "threads"_a, "progress"_a.none());
  module.def("measure_cells", &measure_cells, "sites"_a.noconvert(), "vertices"_a.noconvert(),
             "rings"_a.noconvert(), "cell_rings"_a.noconvert(), "frame"_a, "threads"_a, "progress"_a.none());
  module.def("nearest_neighbours", &nearest_neighbours, "points"_a.noconvert(), "edges"_a.noconvert(),
             "labels"_a.noconvert(), "progress"_a.none());
}

}  // namespace vorotool::bindings
