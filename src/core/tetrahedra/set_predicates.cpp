#include "core/tetrahedra/set_predicates.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>

#include "core/tetrahedra/filter_bounds.hpp"

namespace vorotool::core::tetrahedra {

namespace {

// The determinant of in_sphere is exact in doubles where all sums and products are integers below 2^53: with
// differences of at most x, y, z they are at most 24 x y z (x^2 + y^2 + z^2).
constexpr double exact_product = 0x1p52 / 24;

bool is_integer(double value) { return std::abs(value) <= 0x1p53 && std::trunc(value) == value; }

double largest_of(double a, double b, double c, double d) {
  return std::max(std::max(std::abs(a), std::abs(b)), std::max(std::abs(c), std::abs(d)));
}

// The sign of a tie, from differences whose minors are exact. The determinant is the sum of the lifts, each times its
// cofactor; a lift that is lowered turns the sign of that. A sum of cofactors is 0, which tells that of the last point.
int exact_tie(const std::array<const Point3*, 5>& points, const std::array<Difference3<double>, 4>& p) {
  const auto minor = [&](std::size_t i, std::size_t j, std::size_t k) {
    return orient3d_determinant(std::array{p[i], p[j], p[k]});
  };
  std::array<double, 5> lowered{minor(1, 2, 3), minor(0, 3, 2), minor(0, 1, 3), minor(0, 2, 1), 0};
  lowered[4] = -(lowered[0] + lowered[1]) - (lowered[2] + lowered[3]);
  std::size_t first = 5;
  for (std::size_t k = 0; k < 5; ++k) {
    if (lowered[k] != 0 && (first == 5 || comes_before(*points[k], *points[first]))) first = k;
  }
  return first == 5 ? 0 : numbers::sign_of(lowered[first]);
}

}  // namespace

// With differences of at most (x, y, z) the permanent of orient3d is at most 6 x y z, that of in_sphere
// 24 x y z (x^2 + y^2 + z^2); 1 + 2^-40 covers the roundings of both. Extents that are as large as what the guard of
// in_sphere needs leave everything to the other filter. Integers below 2^m have no roundings at all where the results
// are below 2^53: m <= 16 and m <= 9.
SetPredicates::SetPredicates(std::span<const Point3> points) {
  const auto [x, y, z] = extent_of(points);
  const double largest = std::max({x, y, z});
  const double above = 1 + 0x1p-40;
  const bool in_range = largest <= 0x1p189;
  const double none = std::numeric_limits<double>::infinity();
  orient_bound_ = in_range ? orient_factor * above * (6 * x * y * z + orient_guard * (1 + 3 * z)) : none;
  sphere_bound_ = {none, in_range ? sphere_factor * above * 24 : none, sphere_guard, 0};
  sphere_bound_.all = sphere_bound_.of(SphereBound::product(x, y, z));
  const auto whole = [](const Point3& p) { return is_integer(p.x) && is_integer(p.y) && is_integer(p.z); };
  if (!std::all_of(points.begin(), points.end(), whole)) return;
  sphere_bound_.exact = exact_product;
  if (SphereBound::product(x, y, z) < exact_product) sphere_bound_.all = 0.5;
  orient_exact_ = largest < 0x1p16;
  if (orient_exact_) orient_bound_ = 0.5;
}

unsigned SetPredicates::near_beyond(const std::array<const Point3*, 4>& corners, const Point3& p,
                                    unsigned found, unsigned unsure) {
  const auto [a, b, c, d] = corners;
  const std::array facets{std::array{b, d, c}, std::array{a, c, d}, std::array{a, d, b}, std::array{a, b, c}};
  for (; unsure != 0; unsure &= unsure - 1) {
    const int k = std::countr_zero(unsure);
    const auto [u, v, w] = facets[static_cast<std::size_t>(k)];
    found |= static_cast<unsigned>(orient3d(*u, *v, *w, p) < 0) << k;
  }
  return found;
}

int SetPredicates::near_sphere(const std::array<const Point3*, 5>& points) const {
  const auto [a, b, c, d, e] = points;
  const auto p = differences(*e, *a, *b, *c, *d);
  const double x = largest_of(p[0].x, p[1].x, p[2].x, p[3].x);
  const double y = largest_of(p[0].y, p[1].y, p[2].y, p[3].y);
  const double z = largest_of(p[0].z, p[1].z, p[2].z, p[3].z);
  const double product = SphereBound::product(x, y, z), value = in_sphere_determinant(p);
  if (product < sphere_bound_.exact) return value != 0 ? numbers::sign_of(value) : exact_tie(points, p);
  if (std::abs(value) > sphere_bound_.of(product)) return numbers::sign_of(value);
  return in_sphere_or_tie(*a, *b, *c, *d, *e);
}

}  // namespace vorotool::core::tetrahedra
