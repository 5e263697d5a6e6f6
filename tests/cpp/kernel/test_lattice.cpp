#include <array>

#include "check.hpp"
#include "core/kernel/planar_graph_view.hpp"
#include "core/numbers/int128.hpp"

using namespace vorotool::core::kernel;
using namespace vorotool::tests;
using vorotool::core::base::IndexPair;
using vorotool::core::numbers::int128;

TEST(products_at_the_limit_of_the_lattice_fit) {
  constexpr std::int32_t most = lattice_limit;
  const std::array corners{LatticePoint{-most, -most}, LatticePoint{most, -most}, LatticePoint{most, most},
                           LatticePoint{-most, most}};
  for (const LatticePoint& p : corners) {
    for (const LatticePoint& q : corners) {
      for (const LatticePoint& r : corners) {
        const LatticeVector v = q - p, w = r - p;
        CHECK(int128{cross(v, w)} == int128{v.x} * w.y - int128{v.y} * w.x);
        CHECK(int128{dot(v, w)} == int128{v.x} * w.x + int128{v.y} * w.y);
        equal(dot(v, left_of(v)), 0);
        equal(cross(v, left_of(v)), norm2(v));
      }
    }
  }
}

TEST(points_are_ordered_by_x_then_y) {
  const std::array ordered{Point{-1, 5}, Point{0, -2}, Point{0, 3}, Point{2, -9}};
  for (std::size_t i = 0; i < ordered.size(); ++i) {
    for (std::size_t j = 0; j < ordered.size(); ++j) equal(lexicographic_less(ordered[i], ordered[j]), i < j);
  }
}

TEST(sites_of_a_graph_are_its_points_then_its_segments) {
  const std::array points{LatticePoint{0, 0}, LatticePoint{4, 0}, LatticePoint{4, 3}};
  const std::array segments{IndexPair{0, 1}, IndexPair{2, 1}};
  const PlanarGraphView graph{points, segments, {}};
  equal(graph.site_count(), 5U);
  CHECK(graph.is_point(2) && !graph.is_point(3));
  CHECK(graph.site(1) == LatticeSite{points[1], points[1]});
  CHECK(graph.site(4) == LatticeSite{points[2], points[1]});
  CHECK(graph.is_end(1, 4) && !graph.is_end(0, 4));
  equal(graph.way_from(1, 4).y, 3);
  equal(graph.way_from(2, 4).y, -3);
}
