// Exact signs of the determinants that decide a Delaunay triangulation of space, and the rule for ties.
//
// All are right for all finite doubles, subnormal and huge ones mixed: a filter in floating point settles nearly every
// call, integers the others. The arithmetic must be as core/kernel/predicates.hpp says.
#pragma once

#include <array>
#include <cmath>
#include <span>

#include "core/numbers/sign.hpp"
#include "core/tetrahedra/point3.hpp"

namespace vorotool::core::tetrahedra {

// det(b - a, c - a, d - a): 1 if a, b, c are counter-clockwise seen from d, as the axes are if they are right-handed;
// 0 if the points are coplanar.
int orient3d(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

// 1 if e is inside the sphere through the positive tetrahedron a, b, c, d, -1 outside, 0 on it; the opposite if the
// tetrahedron is negative.
int in_sphere(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& e);

// The same for distinct points, ties broken: never 0 unless a, b, c, d are coplanar. The lifted height of each point,
// the sum of the squares of its coordinates, is lowered infinitesimally, and infinitely more than that of each point
// after it in lexicographic order. The triangulation is that of a lower hull then: a polytope of cospherical points is
// a cone from its first vertex over the facets that miss it, and a facet a fan from its own first vertex ("pulling" of
// the vertices in order). Where the determinant is 0, its sign is that of the first point whose cofactor, the
// orientation of the other four, is not 0.
int in_sphere_or_tie(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& e);
// The sign of a tie alone, for points whose determinant is 0.
int tie_sign(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& e);

// The stages one by one, for the tests. Each gives the sign, or `undecided`; integers decide all, wide ones as well.
int orient3d_filter(const Point3& a, const Point3& b, const Point3& c, const Point3& d);
int orient3d_integers(const Point3& a, const Point3& b, const Point3& c, const Point3& d);
int orient3d_wide(const Point3& a, const Point3& b, const Point3& c, const Point3& d);
int in_sphere_filter(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& e);
int in_sphere_integers(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& e);
int in_sphere_wide(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& e);

// A difference of points, of numbers of any type.
template <class Number>
struct Difference3 {
  Number x, y, z;
};

template <class Number>
auto cross(const Difference3<Number>& p, const Difference3<Number>& q) {
  using Product = decltype(p.x * q.y);
  return Difference3<Product>{p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

template <class Number, class Other>
auto dot(const Difference3<Number>& p, const Difference3<Other>& q) {
  return p.x * q.x + p.y * q.y + p.z * q.z;
}

// The determinants, from the differences to the last point. A product of integers of fixed width is wider, and so is
// each result.
template <class Number>
auto orient3d_determinant(const std::array<Difference3<Number>, 3>& p) {
  const auto& [a, b, c] = p;
  return c.z * (b.x * a.y - a.x * b.y) + (a.z * (c.x * b.y - b.x * c.y) + b.z * (a.x * c.y - c.x * a.y));
}

// Of three of four points each, those behind each point and around: bcd, cda, dab, abc.
template <class Number>
[[gnu::always_inline]] inline auto cofactors(const std::array<Difference3<Number>, 4>& p) {
  const auto& [a, b, c, d] = p;
  const auto ab = a.x * b.y - b.x * a.y, bc = b.x * c.y - c.x * b.y, cd = c.x * d.y - d.x * c.y;
  const auto da = d.x * a.y - a.x * d.y, ac = a.x * c.y - c.x * a.y, bd = b.x * d.y - d.x * b.y;
  return std::array{b.z * cd - c.z * bd + d.z * bc, c.z * da + d.z * ac + a.z * cd,
                    d.z * ab + a.z * bd + b.z * da, a.z * bc - b.z * ac + c.z * ab};
}

template <class Number>
auto in_sphere_determinant(const std::array<Difference3<Number>, 4>& p) {
  const auto lift = [](const Difference3<Number>& v) { return v.x * v.x + v.y * v.y + v.z * v.z; };
  const auto [bcd, cda, dab, abc] = cofactors(p);
  return (lift(p[2]) * dab - lift(p[3]) * abc) + (lift(p[0]) * bcd - lift(p[1]) * cda);
}

template <class... Points>
std::array<Difference3<double>, sizeof...(Points)> differences(const Point3& to, const Points&... points) {
  return {Difference3<double>{points.x - to.x, points.y - to.y, points.z - to.z}...};
}

// The extent along each axis.
Point3 extent_of(std::span<const Point3> points);

// Replaces coordinates by integers below 2^53 where all are on a common lattice that is fine enough for that: they are
// moved and scaled, which changes no sign and no order.
void move_to_integers(std::span<Point3> points);

}  // namespace vorotool::core::tetrahedra
