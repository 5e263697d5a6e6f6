// Radii at which alpha shapes of points in space change: those of the smallest spheres through the corners of edges,
// triangles and tetrahedra. They are square roots of rational numbers, estimated here with a bound of the error, and
// compared exactly: numbers of 128 bits settle small integers, estimates most others, and integers what is left.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/alpha/radius_ranks.hpp"
#include "core/numbers/int128.hpp"
#include "core/tetrahedra/point3.hpp"

namespace vorotool::core::tetrahedral_alpha {

using tetrahedra::Point3;

// The corners of an edge (2), a triangle (3) or a tetrahedron (4): points that are not on one line or in one plane.
struct Simplex {
  std::array<const Point3*, 4> corner{};
  std::size_t size = 0;
};

// Radii, with a relative error of less than 2^-40: doubles that have the same bits but `open_bits` if rounded by these
// as the exact radii have. Nearly all are within 2^-50.
double ranked_radius(const Simplex& simplex, bool are_integers);

// The radius of a simplex, to compare others with.
class ExactRadius {
 public:
  ExactRadius(const Simplex& simplex, bool are_integers);

  // Sign of the difference of the exact radii: that of another, and this one.
  int compare(const Simplex& other) const;

 private:
  // A square of integers that are small.
  struct ShortSquare {
    numbers::int128 numerator = 0, denominator = 0;

    static ShortSquare of(const numbers::int128& n, const numbers::int128& d) { return {n, d}; }
  };
  static std::optional<ShortSquare> short_square(const Simplex& simplex);

  Simplex simplex_;
  bool are_integers_;
  std::optional<ShortSquare> square_;
};

// The square of a radius of points that are not integers, in twice as many digits.
alpha::FineRadius refine_radius(const Simplex& simplex);

// The radius of a tetrahedron; the facets whose smallest spheres hold the opposite corner inside: those that divide it
// from the center of its sphere, with bit k for that opposite to corner k; and the sides, by their numbers
// (edge_stars.hpp), that hold the third corner of one of their two facets in the spheres on them as diameters.
struct TetrahedronMeasure {
  double radius;
  std::uint8_t cut, cut_sides;
};
TetrahedronMeasure measure_tetrahedron(const Simplex& simplex, bool are_integers);

// Whether v is strictly inside the sphere with diameter a, b.
bool is_inside_diametral_sphere(const Point3& a, const Point3& b, const Point3& v, bool are_integers);

}  // namespace vorotool::core::tetrahedral_alpha
