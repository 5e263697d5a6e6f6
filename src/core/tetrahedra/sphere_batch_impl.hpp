// The filter of in_sphere, a lane for each of several tetrahedra.
#pragma once

#include "core/tetrahedra/sphere_batch.hpp"

namespace vorotool::core::tetrahedra {
namespace {

// Arithmetic on all lanes of a vector: `Level` has its bytes, and makes the bits of a mask.
template <class Level>
struct SphereKernel {
  typedef double Vector __attribute__((vector_size(Level::bytes)));
  static constexpr int width = Level::bytes / sizeof(double);

  struct Points {
    Vector x, y, z;
  };

  // The differences of a vertex of each tetrahedron to a point.
  static Points differences(const Point3* points, const int* const (&rows)[width], int vertex,
                            const Point3& p) {
    const auto gather = [&](double Point3::* axis) {
      const auto of = [&](int k) { return points[rows[k][vertex]].*axis; };
      if constexpr (width == 4)
        return Vector{of(0), of(1), of(2), of(3)};
      else
        return Vector{of(0), of(1)};
    };
    return {gather(&Point3::x) - p.x, gather(&Point3::y) - p.y, gather(&Point3::z) - p.z};
  }

  static Vector lift(const Points& v) { return v.x * v.x + v.y * v.y + v.z * v.z; }

  static Vector larger(const Vector& v, const Vector& w) { return v > w ? v : w; }
  static Vector largest(const Vector& a, const Vector& b, const Vector& c, const Vector& d) {
    return larger(larger(larger(a, -a), larger(b, -b)), larger(larger(c, -c), larger(d, -d)));
  }

  // Exact ties, as exact_tie (set_predicates.cpp): the sign is that of the first point in lexicographic order whose
  // lift tells in the sum. Keys are those of differences.
  static Vector key(const Points& v) { return v.x * 0x1p24 + v.y * 0x1p12 + v.z; }
  struct Tie {
    static constexpr double after_all = 0x1p60;
    Vector first = Vector{} + after_all, sign{};

    void add(const Vector& key, const Vector& lowered) {
      const Vector counted = lowered != 0 ? key : Vector{} + after_all;
      sign = counted < first ? lowered : sign;
      first = counted < first ? counted : first;
    }
  };

  // in_sphere_determinant (predicates.hpp) in the same order.
  static SphereSides sides(const Point3* points, const int (*records)[8], const unsigned* tetrahedra,
                           const Point3& p, const SphereBound& bound) {
    const int* rows[width];
    for (int k = 0; k < width; ++k) rows[k] = records[tetrahedra[k]];
    const Points a = differences(points, rows, 0, p), b = differences(points, rows, 1, p);
    const Points c = differences(points, rows, 2, p), d = differences(points, rows, 3, p);
    const Vector ab = a.x * b.y - b.x * a.y, bc = b.x * c.y - c.x * b.y, cd = c.x * d.y - d.x * c.y;
    const Vector da = d.x * a.y - a.x * d.y, ac = a.x * c.y - c.x * a.y, bd = b.x * d.y - d.x * b.y;
    const Vector abc = a.z * bc - b.z * ac + c.z * ab, bcd = b.z * cd - c.z * bd + d.z * bc;
    const Vector cda = c.z * da + d.z * ac + a.z * cd, dab = d.z * ab + a.z * bd + b.z * da;
    const Vector value = (lift(c) * dab - lift(d) * abc) + (lift(a) * bcd - lift(b) * cda);
    const SphereSides sides{Level::mask(value > bound.all), Level::mask(value < -bound.all)};
    if ((sides.inside | sides.outside) + 1 == 1U << width) return sides;
    const Vector x = largest(a.x, b.x, c.x, d.x), y = largest(a.y, b.y, c.y, d.y);
    const Vector z = largest(a.z, b.z, c.z, d.z);
    const Vector product = x * y * z * (x * x + y * y + z * z), near = bound.factor * (product + bound.guard);
    const SphereSides nearer{sides.inside | Level::mask(value > near),
                             sides.outside | Level::mask(value < -near)};
    const unsigned exact =
        Level::mask(product < bound.exact) & Level::mask(larger(larger(x, y), z) < bound.largest_key);
    if (exact == 0) return nearer;
    Tie tie;
    tie.add(0 * x, (bcd - cda) + (dab - abc));
    tie.add(key(a), -bcd), tie.add(key(b), cda), tie.add(key(c), -dab), tie.add(key(d), abc);
    const Vector sign = value == 0 ? tie.sign : value;
    return {nearer.inside | (exact & Level::mask(sign > 0)),
            nearer.outside | (exact & Level::mask(sign < 0))};
  }

  static SphereSides all(const Point3* points, const int (*records)[8], const unsigned* tetrahedra,
                         const Point3& p, const SphereBound& bound) {
    SphereSides result{0, 0};
    for (int k = 0; k < 4; k += width) {
      const SphereSides some = sides(points, records, tetrahedra + k, p, bound);
      result.inside |= some.inside << k;
      result.outside |= some.outside << k;
    }
    return result;
  }
};

}  // namespace
}  // namespace vorotool::core::tetrahedra
