#include "core/tetrahedral_alpha/simplex_measures.hpp"

#include <algorithm>

#include "core/base/indices.hpp"
#include "core/tetrahedral_alpha/radius_batch.hpp"

namespace vorotool::core::tetrahedral_alpha {

namespace {

constexpr std::size_t group = RadiusBatch::group;

template <std::size_t size>
Simplex simplex_of(const base::LargeArray<Point3>& points, const std::array<std::int32_t, size>& corners) {
  Simplex s;
  for (const std::int32_t v : corners) s.corner[s.size++] = &points[base::at(v)];
  return s;
}

}  // namespace

void measure_tetrahedra(const ScaledPoints& points, std::span<const std::array<std::int32_t, 4>> corners,
                        const TetrahedronMeasures& out) {
  const RadiusBatch batch = radius_batch();
  for (std::size_t first = 0; first < corners.size(); first += group) {
    std::array<std::array<std::int32_t, 4>, group> rows;
    std::array<unsigned short, group> known;
    std::array<double, group> found;
    for (std::size_t k = 0; k < group; ++k) rows[k] = corners[std::min(first + k, corners.size() - 1)];
    batch.tetrahedra(points.points.data(), reinterpret_cast<const int (*)[4]>(rows.data()),
                     points.are_integers, found.data(), known.data());
    for (std::size_t k = 0; k < std::min(group, corners.size() - first); ++k) {
      const std::size_t t = first + k;
      TetrahedronMeasure measure{found[k], static_cast<std::uint8_t>(known[k] & 15U),
                                 static_cast<std::uint8_t>(known[k] >> first_side_bit & 63U)};
      if ((known[k] & certain_bit) == 0)
        measure = measure_tetrahedron(simplex_of(points.points, corners[t]), points.are_integers);
      out.radius[t] = measure.radius, out.cut[t] = measure.cut, out.cut_sides[t] = measure.cut_sides;
    }
  }
}

template <std::size_t size>
void measure_simplices(const ScaledPoints& points, std::span<const std::array<std::int32_t, size>> corners,
                       double* radius) {
  const RadiusBatch batch = radius_batch();
  for (std::size_t first = 0; first < corners.size(); first += group) {
    std::array<std::array<std::int32_t, size>, group> rows;
    std::array<double, group> found;
    for (std::size_t k = 0; k < group; ++k) rows[k] = corners[std::min(first + k, corners.size() - 1)];
    const auto* const numbers = reinterpret_cast<const int (*)[size]>(rows.data());
    unsigned certain;
    if constexpr (size == 3)
      certain = batch.triangles(points.points.data(), numbers, found.data());
    else
      certain = batch.edges(points.points.data(), numbers, found.data());
    for (std::size_t k = 0; k < std::min(group, corners.size() - first); ++k) {
      radius[first + k] = (certain >> k & 1U) != 0
                              ? found[k]
                              : ranked_radius(simplex_of(points.points, rows[k]), points.are_integers);
    }
  }
}

template void measure_simplices<3>(const ScaledPoints&, std::span<const std::array<std::int32_t, 3>>,
                                   double*);
template void measure_simplices<2>(const ScaledPoints&, std::span<const std::array<std::int32_t, 2>>,
                                   double*);

}  // namespace vorotool::core::tetrahedral_alpha
