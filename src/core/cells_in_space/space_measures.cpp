#include <cmath>
#include <cstddef>

#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/cells_in_space/space_cells.hpp"

namespace vorotool::core::cells_in_space {

using base::at;

namespace {

constexpr std::size_t faces_a_piece = std::size_t{1} << 14, cells_a_piece = std::size_t{1} << 12;

Point3 less(const Point3& p, const Point3& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }

double dot(const Point3& p, const Point3& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }

// Twice the area of a face, as a vector outwards of its first cell.
Point3 doubled_area(const CellFaces& cells, std::size_t face) {
  const auto begin = static_cast<std::size_t>(cells.face_starts[face]);
  const auto end = static_cast<std::size_t>(cells.face_starts[face + 1]);
  const auto from_first = [&](std::size_t i) {
    return less(cells.vertices[at(cells.corners[i])], cells.vertices[at(cells.corners[begin])]);
  };
  Point3 sum{0, 0, 0};
  for (std::size_t i = begin + 1; i + 1 < end; ++i) {
    const Point3 p = from_first(i), q = from_first(i + 1);
    sum.x += p.y * q.z - p.z * q.y, sum.y += p.z * q.x - p.x * q.z, sum.z += p.x * q.y - p.y * q.x;
  }
  return sum;
}

}  // namespace

SpaceMeasures measure_space_cells(const CellFaces& cells, unsigned threads, const base::Monitor& monitor) {
  const std::size_t faces = cells.face_cells.size(), count = cells.cell_starts.size() - 1;
  std::vector<Point3> doubled(faces);
  SpaceMeasures measures{std::vector<double>(faces), std::vector<double>(count), std::vector<double>(count)};
  base::for_items(faces, faces_a_piece, threads, monitor, [&](std::size_t f) {
    doubled[f] = doubled_area(cells, f);
    measures.face_areas[f] = std::sqrt(dot(doubled[f], doubled[f])) / 2;
  });
  const auto first_corner = [&](std::int32_t face) {
    return cells.vertices[at(cells.corners[static_cast<std::size_t>(cells.face_starts[at(face)])])];
  };
  base::for_items(count, cells_a_piece, threads, monitor, [&](std::size_t i) {
    const auto begin = static_cast<std::size_t>(cells.cell_starts[i]);
    const auto end = static_cast<std::size_t>(cells.cell_starts[i + 1]);
    for (std::size_t k = begin; k < end; ++k) {
      const std::int32_t face = cells.cell_faces[k];
      const double six =
          dot(doubled[at(face)], less(first_corner(face), first_corner(cells.cell_faces[begin])));
      measures.volumes[i] += (at(cells.face_cells[at(face)][0]) == i ? six : -six) / 6;
      measures.areas[i] += measures.face_areas[at(face)];
    }
  });
  return measures;
}

}  // namespace vorotool::core::cells_in_space
