#include <array>
#include <cmath>
#include <vector>

#include "check.hpp"
#include "core/tessellation/simd_level.hpp"
#include "core/tetrahedra/predicates.hpp"
#include "core/tetrahedra/set_predicates.hpp"
#include "core/tetrahedra/sphere_batch.hpp"

using namespace vorotool::core::tetrahedra;
using namespace vorotool::tests;
using vorotool::core::tessellation::Simd;
using vorotool::core::tessellation::supports;
namespace spheres = vorotool::core::tetrahedra::kernels;

namespace {

constexpr std::size_t corners_and_point = 17;  // four tetrahedra, and the point

// On integers of -most to most times a power of two, with offsets that are far below where `is_rough`.
std::vector<Point3> drawn_points(Random& random, std::int64_t most, int exponent, bool is_rough) {
  const auto next = [&] {
    const double offset = is_rough ? std::ldexp(static_cast<double>(random.whole(-3, 3)), -48) : 0;
    return std::ldexp(static_cast<double>(random.whole(-most, most)) + offset, exponent);
  };
  std::vector<Point3> points;
  for (std::size_t k = 0; k < corners_and_point; ++k) points.push_back({next(), next(), next()});
  return points;
}

// How many lanes tell.
int batch_agrees(SphereBatch kernel, const std::vector<Point3>& points, const SetPredicates& predicates,
                 bool is_exact) {
  const Point3& p = points.back();
  int records[4][8] = {};
  const int tetrahedra[4] = {2, 0, 3, 1}, facets[4] = {8, 1, 14, 7};
  for (int k = 0; k < 4; ++k) {
    for (int vertex = 0; vertex < 4; ++vertex) records[k][vertex] = 4 * k + vertex;
  }
  int told = 0;
  const SphereSides sides = kernel(points.data(), records, facets, p, predicates.sphere_bound());
  for (unsigned k = 0; k < 4; ++k) {
    const Point3* corners = &points[4 * tetrahedra[k]];
    if (orient3d(corners[0], corners[1], corners[2], corners[3]) == 0) continue;
    const int side = in_sphere_or_tie(corners[0], corners[1], corners[2], corners[3], p);
    const int found = static_cast<int>(sides.inside >> k & 1) - static_cast<int>(sides.outside >> k & 1);
    CHECK((sides.inside & sides.outside) == 0);
    if (found != 0 || is_exact) equal(found, side);
    told += found != 0;
  }
  return told;
}

bool is_among(const Point3& p, const std::vector<Point3>& points) {
  for (std::size_t k = 0; k + 1 < corners_and_point; ++k) {
    if (points[k].x == p.x && points[k].y == p.y && points[k].z == p.z) return true;
  }
  return false;
}

std::vector<SphereBatch> all_batches() {
  std::vector<SphereBatch> batches{spheres::spheres_portable()};
#if defined(__x86_64__)
  if (supports(Simd::avx2)) batches.push_back(spheres::spheres_avx2());
#endif
  return batches;
}

}  // namespace

TEST(lanes_tell_on_which_side_of_a_sphere_a_point_is) {
  const std::vector<SphereBatch> batches = all_batches();
  Random random(7);
  for (int i = 0; i < 6000; ++i) {
    const std::int64_t most = std::array{1, 2, 200, 1 << 20}[static_cast<std::size_t>(i % 4)];
    const bool is_rough = i % 3 == 1, is_whole = i % 3 == 2;
    const int exponent = is_whole ? 0 : static_cast<int>(random.whole(-60, 60));
    const std::vector<Point3> points = drawn_points(random, most, exponent, is_rough);
    if (is_among(points.back(), points)) continue;
    const SetPredicates predicates(points);
    for (const SphereBatch batch : batches) batch_agrees(batch, points, predicates, is_whole && most <= 200);
  }
}

TEST(facets_tell_what_is_beyond_them) {
  Random random(9);
  for (int i = 0; i < 6000; ++i) {
    const std::int64_t most = std::array{1, 2, 200, 1 << 20}[static_cast<std::size_t>(i % 4)];
    const std::vector<Point3> points =
        drawn_points(random, most, static_cast<int>(random.whole(-60, 60)), i % 3 == 1);
    const auto &a = points[0], &b = points[1], &c = points[2], &d = points[3], &p = points[4];
    if (orient3d(a, b, c, d) <= 0) continue;
    const std::array sides{orient3d(b, d, c, p), orient3d(a, c, d, p), orient3d(a, d, b, p),
                           orient3d(a, b, c, p)};
    unsigned beyond = 0;
    for (unsigned k = 0; k < 4; ++k) beyond |= static_cast<unsigned>(sides[k] < 0) << k;
    for (const unsigned asked : {15U, 11U})
      equal(SetPredicates(points).beyond({&a, &b, &c, &d}, p, asked), beyond & asked);
  }
}

// Points that would be on a sphere, but for rounding, are left to wider numbers by the first filters.
TEST(lanes_tell_points_that_are_nearly_on_a_sphere) {
  const std::vector<SphereBatch> batches = all_batches();
  Random random(8);
  for (const SphereBatch batch : batches) {
    int told = 0;
    for (int i = 0; i < 500; ++i) {
      std::vector<Point3> points;
      for (std::size_t k = 0; k < corners_and_point; ++k) {
        const auto drawn = [&] { return static_cast<double>(random.whole(-1'000'000, 1'000'000)) / 1e6; };
        const double turn = 3 * drawn(), z = drawn(), r = std::sqrt(1 - z * z);
        points.push_back({3 + r * std::cos(turn), r * std::sin(turn) - 5, z});
      }
      told += batch_agrees(batch, points, SetPredicates(points), false);
    }
    CHECK(told > 1900);  // of 2000
  }
}
