#include "core/cells_in_space/space_measures.hpp"

#include <cmath>
#include <cstddef>
#include <span>

#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/cells_in_space/vectors.hpp"

namespace vorotool::core::cells_in_space {

using base::at;

namespace {

constexpr std::size_t faces_a_piece = std::size_t{1} << 14, cells_a_piece = std::size_t{1} << 12;

// Twice the area of a face, as a vector outwards of its first cell.
Point3 doubled_area(const CellFaces& cells, std::size_t face) {
  const std::span<const std::int32_t> ring = cells.face(face);
  const auto from_first = [&](std::size_t i) {
    return cells.vertices[at(ring[i])] - cells.vertices[at(ring[0])];
  };
  Point3 sum{0, 0, 0};
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    sum = sum + vector_product(from_first(i), from_first(i + 1));
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
    measures.face_areas[f] = std::sqrt(scalar_product(doubled[f], doubled[f])) / 2;
  });
  const auto first_corner = [&](std::int32_t face) { return cells.vertices[at(cells.face(at(face))[0])]; };
  base::for_items(count, cells_a_piece, threads, monitor, [&](std::size_t i) {
    for (const std::int32_t face : cells.cell(i)) {
      const double six =
          scalar_product(doubled[at(face)], first_corner(face) - first_corner(cells.cell(i)[0]));
      measures.volumes[i] += (at(cells.face_cells[at(face)][0]) == i ? six : -six) / 6;
      measures.areas[i] += measures.face_areas[at(face)];
    }
  });
  return measures;
}

}  // namespace vorotool::core::cells_in_space
