// The filter of in_sphere, a lane for each of several tetrahedra.
#pragma once

#include "core/tetrahedra/sphere_batch.hpp"

namespace vorotool::core::tetrahedra {
namespace {

// Arithmetic on all lanes of a vector: `Level` has its bytes, makes the bits of a mask, and tells how much less a
// rounded product is than the exact one.
template <class Level>
struct SphereKernel {
  typedef double Vector __attribute__((vector_size(Level::bytes)));
  static constexpr int width = Level::bytes / sizeof(double);

  // Sums of two doubles, about 106 bits (numbers/double_double.hpp, here with sloppy sums): the error of a sum is at
  // most 4 u^2 times that of the absolute terms, the error of a product 7 u^2 times it.
  struct Pair {
    Vector head, tail;

    static Pair ordered_sum(const Vector& a, const Vector& b) {
      const Vector head = a + b;
      return {head, b - (head - a)};
    }
    static Pair exact_sum(const Vector& a, const Vector& b) {
      const Vector head = a + b, from_b = head - a;
      return {head, (a - (head - from_b)) + (b - from_b)};
    }
    friend Pair operator+(const Pair& p, const Pair& q) {
      const Pair heads = exact_sum(p.head, q.head);
      return ordered_sum(heads.head, heads.tail + (p.tail + q.tail));
    }
    friend Pair operator-(const Pair& p, const Pair& q) { return p + Pair{-q.head, -q.tail}; }
    friend Pair operator*(const Pair& p, const Pair& q) {
      const Vector head = p.head * q.head, tail = Level::product_error(p.head, q.head, head);
      return ordered_sum(head, tail + (p.head * q.tail + p.tail * q.head));
    }
  };

  // Points, and what in_sphere_determinant makes of four: its value and the cofactors of the lifts.
  struct Points {
    Vector x, y, z;
    struct Determinant {
      Vector value, abc, bcd, cda, dab;
    };
  };
  struct PairPoints {
    Pair x, y, z;
    struct Determinant {
      Pair value, abc, bcd, cda, dab;
    };
  };

  // A vertex of each tetrahedron.
  static Points vertices(const Point3* points, const int* const (&rows)[width], int vertex) {
    const auto gather = [&](double Point3::* axis) {
      const auto of = [&](int k) { return points[rows[k][vertex]].*axis; };
      if constexpr (width == 4)
        return Vector{of(0), of(1), of(2), of(3)};
      else
        return Vector{of(0), of(1)};
    };
    return {gather(&Point3::x), gather(&Point3::y), gather(&Point3::z)};
  }

  static Vector larger(const Vector& v, const Vector& w) { return v > w ? v : w; }
  static Vector largest(const Vector& a, const Vector& b, const Vector& c, const Vector& d) {
    return larger(larger(larger(a, -a), larger(b, -b)), larger(larger(c, -c), larger(d, -d)));
  }

  // As predicates.hpp, in the same order.
  template <class Points>
  static auto determinant(const Points& a, const Points& b, const Points& c, const Points& d) {
    const auto lift = [](const Points& v) { return v.x * v.x + v.y * v.y + v.z * v.z; };
    const auto ab = a.x * b.y - b.x * a.y, bc = b.x * c.y - c.x * b.y, cd = c.x * d.y - d.x * c.y;
    const auto da = d.x * a.y - a.x * d.y, ac = a.x * c.y - c.x * a.y, bd = b.x * d.y - d.x * b.y;
    const auto abc = a.z * bc - b.z * ac + c.z * ab, bcd = b.z * cd - c.z * bd + d.z * bc;
    const auto cda = c.z * da + d.z * ac + a.z * cd, dab = d.z * ab + a.z * bd + b.z * da;
    const auto value = (lift(c) * dab - lift(d) * abc) + (lift(a) * bcd - lift(b) * cda);
    return typename Points::Determinant{value, abc, bcd, cda, dab};
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

  static SphereSides sides_of(const Vector& value, const Vector& bound) {
    return {Level::mask(value > bound), Level::mask(value < -bound)};
  }

  static SphereSides sides(const Point3* points, const int (*records)[8], const int* facets, const Point3& p,
                           const SphereBound& bound) {
    const int* rows[width];
    for (int k = 0; k < width; ++k) rows[k] = records[static_cast<unsigned>(facets[k]) / 4];
    const auto difference = [&](int vertex) {
      const Points v = vertices(points, rows, vertex);
      return Points{v.x - p.x, v.y - p.y, v.z - p.z};
    };
    const Points a = difference(0), b = difference(1), c = difference(2), d = difference(3);
    const auto [value, abc, bcd, cda, dab] = determinant(a, b, c, d);
    SphereSides found = sides_of(value, Vector{} + bound.all);
    if (found.are_all(width)) return found;
    const Vector x = largest(a.x, b.x, c.x, d.x), y = largest(a.y, b.y, c.y, d.y);
    const Vector z = largest(a.z, b.z, c.z, d.z);
    const Vector product = x * y * z * (x * x + y * y + z * z);
    found.add(sides_of(value, bound.factor * (product + bound.guard)));
    const unsigned exact =
        Level::mask(product < bound.exact) & Level::mask(larger(larger(x, y), z) < bound.largest_key);
    if (exact != 0) {
      Tie tie;
      tie.add(0 * x, (bcd - cda) + (dab - abc));
      tie.add(key(a), -bcd), tie.add(key(b), cda), tie.add(key(c), -dab), tie.add(key(d), abc);
      const SphereSides known = sides_of(value == 0 ? tie.sign : value, Vector{});
      found.add({known.inside & exact, known.outside & exact});
    }
    const unsigned finite = Level::mask(value == value);  // no vertex is NaN
    if ((finite & ~(found.inside | found.outside)) != 0)
      found.add(near_sides(points, rows, p, bound, product));
    return found;
  }

  // The same of pairs. With exact differences a monomial meets sums and products that are worth 56 u^2, and 2^-50 of
  // the bound above is worth 128 u^2. Underflows are worth less than 32 times those there, and the guard 2^7 times.
  static SphereSides near_sides(const Point3* points, const int* const (&rows)[width], const Point3& p,
                                const SphereBound& bound, const Vector& product) {
    const auto difference = [&](int vertex) {
      const Points v = vertices(points, rows, vertex);
      return PairPoints{Pair::exact_sum(v.x, Vector{} - p.x), Pair::exact_sum(v.y, Vector{} - p.y),
                        Pair::exact_sum(v.z, Vector{} - p.z)};
    };
    const Pair value = determinant(difference(0), difference(1), difference(2), difference(3)).value;
    return sides_of(value.head, bound.factor * (product * 0x1p-50 + bound.guard));
  }

  static SphereSides all(const Point3* points, const int (*records)[8], const int* facets, const Point3& p,
                         const SphereBound& bound) {
    SphereSides result{0, 0};
    for (int k = 0; k < 4; k += width) {
      const SphereSides some = sides(points, records, facets + k, p, bound);
      result.add({some.inside << k, some.outside << k});
    }
    return result;
  }
};

}  // namespace
}  // namespace vorotool::core::tetrahedra
