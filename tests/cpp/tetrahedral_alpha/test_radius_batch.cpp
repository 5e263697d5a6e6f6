#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "check.hpp"
#include "core/alpha/radius_ranks.hpp"
#include "core/tessellation/simd_level.hpp"
#include "core/tetrahedra/predicates.hpp"
#include "core/tetrahedral_alpha/edge_stars.hpp"
#include "core/tetrahedral_alpha/radius_batch.hpp"
#include "core/tetrahedral_alpha/radius_bounds.hpp"
#include "core/tetrahedral_alpha/simplex_radius.hpp"

using namespace vorotool::core::tetrahedral_alpha;
using namespace vorotool::tests;
using vorotool::core::tessellation::Simd;
using vorotool::core::tessellation::supports;
namespace radii = vorotool::core::tetrahedral_alpha::kernels;

namespace {

constexpr std::size_t group = RadiusBatch::group;

std::vector<RadiusBatch> batches() {
  std::vector<RadiusBatch> found{radii::radii_portable()};
#if defined(__x86_64__)
  if (supports(Simd::avx2)) found.push_back(radii::radii_avx2());
#endif
  return found;
}

// Four points for each lane: integers of 0 to most times a power of two, with offsets that are far below where `is_rough`.
std::vector<Point3> corners_of_lanes(Random& random, std::int64_t most, int exponent, bool is_rough) {
  const auto next = [&] {
    const double offset = is_rough ? std::ldexp(static_cast<double>(random.whole(0, 3)), -48) : 0;
    return std::ldexp(static_cast<double>(random.whole(0, most)) + offset, exponent);
  };
  std::vector<Point3> points;
  for (std::size_t k = 0; k < 4 * group; ++k) points.push_back({next(), next(), next()});
  return points;
}

struct Lanes {
  std::array<double, group> radius{};
  std::array<unsigned short, group> known{};
};

template <std::size_t size>
std::array<int[size], group> rows() {
  std::array<int[size], group> found;
  for (std::size_t k = 0; k < group; ++k) {
    for (std::size_t corner = 0; corner < size; ++corner) found[k][corner] = static_cast<int>(4 * k + corner);
  }
  return found;
}

Lanes tetrahedra_of(const RadiusBatch& batch, const std::vector<Point3>& points, bool are_integers) {
  Lanes found;
  batch.tetrahedra(points.data(), rows<4>().data(), are_integers, found.radius.data(), found.known.data());
  return found;
}

bool is_flat(const Point3* corner) {
  return vorotool::core::tetrahedra::orient3d(corner[0], corner[1], corner[2], corner[3]) == 0;
}

// What lanes are certain of is what the exact radius and the spheres on sides say.
void is_right(const Lanes& lanes, std::size_t k, const Point3* corner, bool are_integers) {
  using vorotool::core::alpha::rounded_by;
  const Simplex simplex{{corner, corner + 1, corner + 2, corner + 3}, 4};
  equal(rounded_by(bounds::open_bits, lanes.radius[k]),
        rounded_by(bounds::open_bits, ranked_radius(simplex, are_integers)));
  unsigned sides = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) {
      for (std::size_t v = 0; v < 4; ++v) {
        if (v != a && v != b && is_inside_diametral_sphere(corner[a], corner[b], corner[v], false))
          sides |= 1U << (first_side_bit + side_between[a][b]);
      }
    }
  }
  equal(unsigned{lanes.known[k]} & ~((1U << first_side_bit) - 1), sides | certain_bit);
}

// How many lanes are certain of triangles or edges of these corners, which have the radii of single ones.
template <std::size_t size>
int right_lanes(unsigned (*radii)(const Point3*, const int (*)[size], double*),
                const std::vector<Point3>& points) {
  std::array<double, group> radius;
  const unsigned known = radii(points.data(), rows<size>().data(), radius.data());
  int certain = 0;
  for (std::size_t k = 0; k < group; ++k) {
    if ((known >> k & 1U) == 0) continue;
    Simplex simplex;
    while (simplex.size < size) {
      simplex.corner[simplex.size] = &points[4 * k + simplex.size];
      ++simplex.size;
    }
    equal(std::bit_cast<std::uint64_t>(radius[k]),
          std::bit_cast<std::uint64_t>(ranked_radius(simplex, false)));
    ++certain;
  }
  return certain;
}

}  // namespace

TEST(lanes_of_tetrahedra_agree_with_each_other_and_with_exact_radii) {
  Random random(11);
  int certain = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::int64_t most = std::array{1, 3, 200, 1 << 20}[static_cast<std::size_t>(i % 4)];
    const bool are_integers = i % 3 == 2;
    const std::vector<Point3> points = corners_of_lanes(
        random, most, are_integers ? 0 : static_cast<int>(random.whole(-70, 70)), i % 3 == 1);
    const Lanes first = tetrahedra_of(radii::radii_portable(), points, are_integers);
    for (const RadiusBatch& batch : batches()) {
      const Lanes found = tetrahedra_of(batch, points, are_integers);
      for (std::size_t k = 0; k < group; ++k) {
        equal(found.known[k] & certain_bit, first.known[k] & certain_bit);
        if ((found.known[k] & certain_bit) == 0) continue;
        equal(found.known[k], first.known[k]);
        equal(std::bit_cast<std::uint64_t>(found.radius[k]), std::bit_cast<std::uint64_t>(first.radius[k]));
        CHECK(!is_flat(&points[4 * k]));
        is_right(found, k, &points[4 * k], are_integers);
        ++certain;
      }
    }
  }
  CHECK(certain > 5000);
}

TEST(lanes_of_triangles_and_edges_have_the_radii_of_single_ones) {
  Random random(12);
  int certain = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::int64_t most = std::array{1, 3, 200, 1 << 20}[static_cast<std::size_t>(i % 4)];
    const std::vector<Point3> points =
        corners_of_lanes(random, most, static_cast<int>(random.whole(-70, 70)), i % 3 == 1);
    for (const RadiusBatch& batch : batches()) {
      certain += right_lanes<3>(batch.triangles, points) + right_lanes<2>(batch.edges, points);
    }
  }
  CHECK(certain > 10000);
}
