// Voronoi cells of points in space.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/base/indices.hpp"
#include "core/cells_in_space/space_cells.hpp"
#include "core/cells_in_space/space_measures.hpp"
#include "core/cells_in_space/verify_space_cells.hpp"

namespace vorotool::bindings {
namespace {

using namespace core::cells_in_space;
using Starts = Vector<const std::int64_t>;

// An array of rows that takes over the values.
template <class Value, class Row>
Array<Value> to_rows(std::vector<Row>&& values) {
  auto kept = std::make_unique<std::vector<Row>>(std::move(values));
  Value* data = reinterpret_cast<Value*>(kept->data());
  const std::size_t size = kept->size();
  return owned(std::move(kept), data, {size, sizeof(Row) / sizeof(Value)});
}

Box3 box_of(const Vector<const double>& box) {
  if (box.size() != 6) throw std::invalid_argument("a box has six numbers");
  const double* side = box.data();
  return {{side[0], side[1], side[2]}, {side[3], side[4], side[5]}};
}

Columns space_cells(const Places& points, const IndexRows& tetrahedra, const IndexRows& neighbors,
                    const IndexRows& edges, const Indices& first, const Vector<const double>& box,
                    unsigned threads, const Progress& progress) {
  const SpaceMesh mesh{rows<Point3>(points), rows<SpaceMesh::Row>(tetrahedra),
                       rows<SpaceMesh::Row>(neighbors), rows<core::base::IndexPair>(edges), view(first)};
  if (mesh.tetrahedra.size() != mesh.neighbors.size() || mesh.first.size() != mesh.points.size())
    throw std::invalid_argument("the arrays do not have the lengths of each other");
  core::base::check_range(view(tetrahedra), 0, mesh.points.size(), "an index is out of range");
  core::base::check_range(view(edges), 0, mesh.points.size(), "an index is out of range");
  core::base::check_range(view(neighbors), -1, mesh.tetrahedra.size(), "an index is out of range");
  SpaceCells made =
      run_interruptible(progress, core::cells_in_space::space_cells, mesh, box_of(box), threads);
  Columns result;
  result["vertices"] = to_rows<double>(std::move(made.vertices));
  result["face_starts"] = to_numpy(std::move(made.face_starts));
  result["corners"] = to_numpy(std::move(made.corners));
  result["face_cells"] = to_rows<std::int32_t>(std::move(made.face_cells));
  result["cell_starts"] = to_numpy(std::move(made.cell_starts));
  result["cell_faces"] = to_numpy(std::move(made.cell_faces));
  return result;
}

CellFaces faces_of(const Places& vertices, const Starts& face_starts, const Indices& corners,
                   const IndexRows& face_cells, const Starts& cell_starts, const Indices& cell_faces) {
  const CellFaces cells{rows<Point3>(vertices), view(face_starts),
                        view(corners),          rows<core::base::IndexPair>(face_cells),
                        view(cell_starts),      view(cell_faces)};
  const auto are_starts = [](std::span<const std::int64_t> starts, std::size_t items) {
    return !starts.empty() && starts.front() == 0 && std::is_sorted(starts.begin(), starts.end()) &&
           starts.back() == static_cast<std::int64_t>(items);
  };
  if (!are_starts(cells.face_starts, cells.corners.size()) ||
      !are_starts(cells.cell_starts, cells.cell_faces.size()) ||
      cells.face_starts.size() != cells.face_cells.size() + 1)
    throw std::invalid_argument("the arrays do not have the lengths of each other");
  core::base::check_range(cells.corners, 0, cells.vertices.size(), "an index is out of range");
  core::base::check_range(cells.cell_faces, 0, cells.face_cells.size(), "an index is out of range");
  return cells;
}

Columns measures(const Places& vertices, const Starts& face_starts, const Indices& corners,
                 const IndexRows& face_cells, const Starts& cell_starts, const Indices& cell_faces,
                 unsigned threads, const Progress& progress) {
  const CellFaces cells = faces_of(vertices, face_starts, corners, face_cells, cell_starts, cell_faces);
  SpaceMeasures made = run_interruptible(progress, measure_space_cells, cells, threads);
  Columns result;
  result["face_areas"] = to_numpy(std::move(made.face_areas));
  result["volumes"] = to_numpy(std::move(made.volumes));
  result["areas"] = to_numpy(std::move(made.areas));
  return result;
}

std::optional<std::string> find_fault(const Places& sites, const Places& vertices, const Starts& face_starts,
                                      const Indices& corners, const IndexRows& face_cells,
                                      const Starts& cell_starts, const Indices& cell_faces,
                                      const Vector<const double>& box, unsigned threads,
                                      const Progress& progress) {
  const CellFaces cells = faces_of(vertices, face_starts, corners, face_cells, cell_starts, cell_faces);
  const auto points = rows<Point3>(sites);
  if (cells.cell_starts.size() != points.size() + 1)
    throw std::invalid_argument("the arrays do not have the lengths of each other");
  core::base::check_range(view(face_cells), -static_cast<std::int32_t>(box_sides), points.size(),
                          "an index is out of range");
  return run_interruptible(progress, find_space_cell_fault, points, cells, box_of(box), threads);
}

}  // namespace

void bind_cells_in_space(nb::module_& room) {
  room.def("space_cells", &space_cells, "points"_a, "tetrahedra"_a, "neighbors"_a, "edges"_a, "first"_a,
           "box"_a, "threads"_a, "progress"_a.none(),
           "vertices; faces, counter-clockwise as seen from outside the first of their cells, the second "
           "being -1 - "
           "side on the box; faces of each cell. The edges are used where there are no tetrahedra.");
  room.def("measures", &measures, "vertices"_a, "face_starts"_a, "corners"_a, "face_cells"_a, "cell_starts"_a,
           "cell_faces"_a, "threads"_a, "progress"_a.none(), "face_areas, and volumes and areas of cells.");
  room.def("find_fault", &find_fault, "sites"_a, "vertices"_a, "face_starts"_a, "corners"_a, "face_cells"_a,
           "cell_starts"_a, "cell_faces"_a, "box"_a, "threads"_a, "progress"_a.none());
}

}  // namespace vorotool::bindings
