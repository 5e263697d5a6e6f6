// Estimates of radii, a lane for each of several simplices.
#pragma once

#include "core/tetrahedral_alpha/radius_batch.hpp"
#include "core/tetrahedral_alpha/radius_bounds.hpp"

namespace vorotool::core::tetrahedral_alpha {
namespace {

// Arithmetic on all lanes of a vector, in the order of simplex_radius.cpp: `Level` has its bytes, and square roots.
template <class Level>
struct RadiusKernel {
  typedef double Vector __attribute__((vector_size(Level::bytes)));
  typedef long long Bits __attribute__((vector_size(Level::bytes)));
  static constexpr int width = Level::bytes / sizeof(double);

  struct Points {
    Vector x, y, z;
  };

  template <int corners>
  static Points corner(const Point3* points, const int (*rows)[corners], int k) {
    const auto gather = [&](double Point3::* axis) {
      const auto of = [&](int lane) { return points[rows[lane][k]].*axis; };
      if constexpr (width == 4)
        return Vector{of(0), of(1), of(2), of(3)};
      else
        return Vector{of(0), of(1)};
    };
    return {gather(&Point3::x), gather(&Point3::y), gather(&Point3::z)};
  }

  static Points from_to(const Points& a, const Points& b) { return {b.x - a.x, b.y - a.y, b.z - a.z}; }
  static Vector dot(const Points& p, const Points& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }
  static Points cross(const Points& p, const Points& q) {
    return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
  }
  static Points permanents(const Points& p, const Points& q) {
    return {p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x};
  }
  static Points times(const Vector& f, const Points& p) { return {f * p.x, f * p.y, f * p.z}; }
  static Points sum(const Points& p, const Points& q, const Points& r) {
    return {p.x + q.x + r.x, p.y + q.y + r.y, p.z + q.z + r.z};
  }

  static Vector absolute(const Vector& v) {
    return reinterpret_cast<Vector>(reinterpret_cast<Bits>(v) & 0x7fffffffffffffffLL);
  }
  static Points absolute(const Points& p) { return {absolute(p.x), absolute(p.y), absolute(p.z)}; }
  static Vector larger(const Vector& v, const Vector& w) { return v > w ? v : w; }
  static Vector extent(const Points& p) { return larger(larger(p.x, p.y), p.z); }
  static Bits is_in_range(const Vector& size) {
    return (size >= bounds::smallest) & (size <= bounds::largest);
  }

  struct Lanes {
    long long of[width];
    explicit Lanes(const Bits& bits) { __builtin_memcpy(of, &bits, sizeof(bits)); }
  };

  static Bits rounded(const Vector& value) {
    constexpr long long unit = 1LL << bounds::open_bits;
    return (reinterpret_cast<Bits>(value) + unit / 2) & ~(unit - 1);
  }

  static Bits is_settled(const Vector& radius, const Vector& error) {
    return (error < bounds::worst_error) & (rounded(radius * (1 - error)) == rounded(radius * (1 + error)));
  }

  // The sides of triangles that hold the opposite corner in the spheres on them as diameters: that is, whose square is
  // larger than those of the two others.
  struct Sides {
    Vector exact;  // sums below are exact
    Bits known{}, certain = Bits{} - 1;

    void add(const Vector (&squares)[3], const int (&side)[3]) {
      const Vector total = squares[0] + squares[1] + squares[2];
      const Vector error = total < exact ? Vector{} : bounds::side_error * total + bounds::side_guard;
      certain &= total < 0x1p1000;
      for (int k = 0; k < 3; ++k) {
        const Vector excess = 2 * squares[k] - total;
        certain &= absolute(excess) >= error;
        known |= (excess > 0) & (1LL << (first_side_bit + static_cast<unsigned>(side[k])));
      }
    }
  };

  static void tetrahedra(const Point3* points, const int (*rows)[4], bool are_integers, double* radius,
                         unsigned short* known) {
    const Points a = corner(points, rows, 0), bb = corner(points, rows, 1), cc = corner(points, rows, 2),
                 dd = corner(points, rows, 3);
    const Points b = from_to(a, bb), c = from_to(a, cc), d = from_to(a, dd);
    const Points bc = from_to(bb, cc), bd = from_to(bb, dd), cd = from_to(cc, dd);
    const Vector b2 = dot(b, b), c2 = dot(c, c), d2 = dot(d, d);
    const Vector bc2 = dot(bc, bc), bd2 = dot(bd, bd), cd2 = dot(cd, cd);
    Sides sides{Vector{} + (are_integers ? bounds::exact_limit : -1)};
    sides.add({bc2, bd2, cd2}, {3, 4, 5});
    sides.add({c2, d2, cd2}, {1, 2, 5});
    sides.add({b2, d2, bd2}, {0, 2, 4});
    sides.add({b2, c2, bc2}, {0, 1, 3});

    const Points n0 = cross(c, d), n1 = cross(d, b), n2 = cross(b, c);
    const Vector determinant = dot(b, n0), size = absolute(determinant);
    const Points center = sum(times(b2, n0), times(c2, n1), times(d2, n2));
    const Points pb = absolute(b), pc = absolute(c), pd = absolute(d);
    const Points t0 = permanents(pc, pd), t1 = permanents(pd, pb), t2 = permanents(pb, pc);
    const Vector determinant_terms = dot(pb, t0);
    const Points center_terms = sum(times(b2, t0), times(c2, t1), times(d2, t2));

    const Vector first = dot(center, n0), second = dot(center, n1), third = dot(center, n2);
    const Vector square = determinant * determinant;
    const Vector heights[4] = {square + square - (first + second + third), first, second, third};
    Vector terms[4] = {{}, dot(center_terms, t0), dot(center_terms, t1), dot(center_terms, t2)};
    terms[0] = 2 * determinant_terms * determinant_terms + terms[1] + terms[2] + terms[3];
    const Bits exact = terms[0] < sides.exact;
    Bits found = sides.known, certain = sides.certain & (size >= bounds::least_determinant) &
                                        is_in_range(larger(extent(pb), larger(extent(pc), extent(pd))));
    for (int k = 0; k < 4; ++k) {
      certain &= exact | (absolute(heights[k]) > bounds::height_error * terms[k] + bounds::height_guard);
      found |= (heights[k] < 0) & (1LL << k);
    }

    const Vector center2 = dot(center, center);
    const Vector spread = Level::root(dot(center_terms, center_terms) / center2);
    const Vector value = Level::root(center2 / (4 * size * size));
    const Vector error = bounds::center_error * spread +
                         bounds::determinant_error * (determinant_terms / size) + bounds::few_roundings;
    certain &= is_settled(value, error);
    found |= certain & static_cast<long long>(certain_bit);
    __builtin_memcpy(radius, &value, sizeof(value));
    const Lanes lanes(found);
    for (int lane = 0; lane < width; ++lane) known[lane] = static_cast<unsigned short>(lanes.of[lane]);
  }

  static Bits triangles(const Point3* points, const int (*rows)[3], double* radius) {
    const Points first = corner(points, rows, 0), second = corner(points, rows, 1),
                 third = corner(points, rows, 2);
    const Points b = from_to(first, second), c = from_to(first, third), side = from_to(second, third);
    const Points pb = absolute(b), pc = absolute(c);
    const Points normal = cross(b, c), terms = permanents(pb, pc);
    const Vector square = dot(normal, normal);
    const Vector spread = Level::root(dot(terms, terms) / square);
    const Vector value = Level::root(dot(b, b) * dot(c, c) * dot(side, side) / (4 * square));
    __builtin_memcpy(radius, &value, sizeof(value));
    return is_in_range(larger(extent(pb), extent(pc))) & (square >= bounds::least_determinant) &
           is_settled(value, bounds::normal_error * spread + 2 * bounds::few_roundings);
  }

  static Bits edges(const Point3* points, const int (*rows)[2], double* radius) {
    const Points way = from_to(corner(points, rows, 0), corner(points, rows, 1));
    const Vector value = Level::root(dot(way, way)) / 2;
    __builtin_memcpy(radius, &value, sizeof(value));
    return is_in_range(extent(absolute(way))) & is_settled(value, Vector{} + bounds::few_roundings);
  }

  static void all_tetrahedra(const Point3* points, const int (*rows)[4], bool are_integers, double* radius,
                             unsigned short* known) {
    for (int k = 0; k < RadiusBatch::group; k += width)
      tetrahedra(points, rows + k, are_integers, radius + k, known + k);
  }

  template <int corners, Bits (*some)(const Point3*, const int (*)[corners], double*)>
  static unsigned all(const Point3* points, const int (*rows)[corners], double* radius) {
    unsigned result = 0;
    for (int k = 0; k < RadiusBatch::group; k += width) {
      const Lanes certain(some(points, rows + k, radius + k));
      for (int lane = 0; lane < width; ++lane)
        result |= static_cast<unsigned>(certain.of[lane] & 1) << (k + lane);
    }
    return result;
  }

  static constexpr RadiusBatch batch{all_tetrahedra, all<3, triangles>, all<2, edges>};
};

}  // namespace
}  // namespace vorotool::core::tetrahedral_alpha
