#include <cmath>
#include <span>
#include <vector>

#include "check.hpp"
#include "core/delaunay/delaunay_triangulation.hpp"
#include "core/tetrahedra/delaunay_tetrahedra.hpp"
#include "core/tetrahedral_alpha/space_complex.hpp"

using namespace vorotool::core;
using namespace vorotool::tests;
using tetrahedra::Point3;

namespace {

constexpr std::size_t count = 50'000;  // so many that three threads insert points at the same time

// In a cube, or about a few places, on whole numbers below so many.
std::vector<Point3> drawn_points(Random& random, std::int64_t most, bool are_clouds) {
  const auto next = [&] { return static_cast<double>(random.whole(0, most)); };
  const auto offset = [&] { return are_clouds ? static_cast<double>(most * random.whole(0, 3)) * 20 : 0; };
  std::vector<Point3> points;
  while (points.size() < count) points.push_back({next() + offset(), next() + offset(), next() + offset()});
  return points;
}

template <class Items, class Others>
void same(const Items& items, const Others& others) {
  equal(items.size(), others.size());
  std::size_t different = 0;
  for (std::size_t k = 0; k < items.size(); ++k) different += items[k] != others[k];
  equal(different, std::size_t{0});
}

void threads_agree(std::span<const Point3> points) {
  const tetrahedra::Tetrahedra one = tetrahedra::triangulate(points, 1, {});
  const tetrahedral_alpha::SpaceInput input{
      points, {one.vertices.data(), one.count}, {one.neighbors.data(), one.count}, {}, {}};
  const tetrahedral_alpha::SpaceArrays alpha = tetrahedral_alpha::space_complex(input, 1, {});
  const tetrahedra::Tetrahedra more = tetrahedra::triangulate(points, 3, {});
  same(more.vertices, one.vertices);
  same(more.neighbors, one.neighbors);
  same(more.first, one.first);
  const tetrahedral_alpha::SpaceArrays found = tetrahedral_alpha::space_complex(input, 3, {});
  same(found.triangle_min, alpha.triangle_min);
  same(found.edge_max, alpha.edge_max);
  same(found.spectrum, alpha.spectrum);
}

}  // namespace

TEST(threads_make_the_same_tetrahedra_and_alpha_values) {
  Random random(9);
  threads_agree(drawn_points(random, std::int64_t{1} << 40, false));
  threads_agree(drawn_points(random, std::int64_t{1} << 40, true));
  threads_agree(drawn_points(random, 80, false));
}

TEST(threads_make_the_same_triangles) {
  Random random(10);
  std::vector<kernel::Point> points;
  for (const Point3& p : drawn_points(random, std::int64_t{1} << 40, false)) points.push_back({p.x, p.y});
  const auto triangles = [&](unsigned threads) {
    const delaunay::DelaunayTriangulation mesh(points, threads, {});
    std::vector<std::int32_t> found(3 * mesh.triangle_count());
    mesh.write({.triangles = found.data()}, threads, {});
    return found;
  };
  same(triangles(3), triangles(1));
}
