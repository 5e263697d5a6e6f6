#include "core/tetrahedra/spheres.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <type_traits>

#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/numbers/double_double.hpp"
#include "core/numbers/expansion.hpp"
#include "core/numbers/sign.hpp"
#include "core/tetrahedra/predicates.hpp"

namespace vorotool::core::tetrahedra {

using numbers::DoubleDouble;
using numbers::unit_roundoff;

namespace {

constexpr std::size_t tetrahedra_a_piece = std::size_t{1} << 13;

// Of differences in this range no product of five is so large or so small that what underflows is worth anything
// beside the roundings of the others, where the bound is met.
constexpr double least_size = 0x1p-150, most_size = 0x1p150;

// The relative error of every operation, at most: those of two doubles have 7 u^2 for products, 3 u^2 for sums, and
// 15 u^2 for quotients. In double-double half of that or less is used below, as differences are exact.
template <class Number>
constexpr double operation_error = unit_roundoff;
template <>
constexpr double operation_error<DoubleDouble> = 4 * unit_roundoff * unit_roundoff;

Difference3<double> magnitudes(const Difference3<double>& p) {
  return {std::abs(p.x), std::abs(p.y), std::abs(p.z)};
}
double sum(const Difference3<double>& p) { return p.x + p.y + p.z; }

// What cross gives where no two terms have different signs.
Difference3<double> absolute_cross(const Difference3<double>& p, const Difference3<double>& q) {
  return {p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x};
}

template <class Number>
Difference3<Number> difference(const Point3& p, const Point3& from) {
  if constexpr (std::is_same_v<Number, double>) {
    return {p.x - from.x, p.y - from.y, p.z - from.z};
  } else {
    return {numbers::two_difference(p.x, from.x), numbers::two_difference(p.y, from.y),
            numbers::two_difference(p.z, from.z)};
  }
}

Difference3<double> rounded(const Difference3<double>& p) { return p; }
Difference3<double> rounded(const Difference3<DoubleDouble>& p) { return {p.x.head, p.y.head, p.z.head}; }

// A monomial of a difference each meets: of six volumes 8 roundings (three differences, two of a minor, the last
// product and two sums), of a coordinate of the numerator 12 (four differences, three of a square sum, two of a minor,
// the last product and two sums). With P and P' the sums of absolute monomials of both, n / (2 d) errs by at most
//   (12 e P' + 2 |way| 8 e P) / (2 d) + e |way|,
// and 13 and 9 in place of 12 and 8 cover terms of higher order, and the roundings of the bound, where 9 e P < d / 32.
// Of two doubles, differences have no errors, and 8 products and sums of 7 e' and 3 e' at most: 23 e' and 36 e', with
// 4 e' = e, where the quotient and the rounding to one double are e |way| and more.
template <class Number>
std::optional<Sphere> estimated(const std::array<Point3, 4>& corners, double enough) {
  constexpr double e = operation_error<Number>;
  const auto b = difference<Number>(corners[1], corners[0]), c = difference<Number>(corners[2], corners[0]);
  const auto d = difference<Number>(corners[3], corners[0]);
  const auto ab = magnitudes(rounded(b)), ac = magnitudes(rounded(c)), ad = magnitudes(rounded(d));
  const double size = std::max({sum(ab), sum(ac), sum(ad)});
  if (!(size > least_size && size < most_size)) return {};
  const auto normal_b = cross(c, d), normal_c = cross(d, b), normal_d = cross(b, c);
  const Number six = dot(b, normal_b), bb = dot(b, b), cc = dot(c, c), dd = dot(d, d);
  const double six_rounded = static_cast<double>(six);
  const auto absolute_b = absolute_cross(ac, ad);
  const double permanent = dot(ab, absolute_b), six_error = 9 * e * permanent;
  if (!(six_rounded * std::min(enough / 2, 1.0 / 32) > six_error)) return {};
  const auto over = [&](const Number& x, const Number& y, const Number& z) {
    return static_cast<double>((bb * x + cc * y + dd * z) / (Number(2.0) * six));
  };
  const Point3 way{over(normal_b.x, normal_c.x, normal_d.x), over(normal_b.y, normal_c.y, normal_d.y),
                   over(normal_b.z, normal_c.z, normal_d.z)};
  const double numerator = dot(ab, ab) * sum(absolute_b) + dot(ac, ac) * sum(absolute_cross(ad, ab)) +
                           dot(ad, ad) * sum(absolute_cross(ab, ac));
  const Difference3<double> length = magnitudes({way.x, way.y, way.z});
  const double error = (13 * e * numerator + 2 * sum(length) * six_error) / (2 * six_rounded) +
                       2 * unit_roundoff * sum(length);
  if (!(error <= enough * std::max({length.x, length.y, length.z}))) return {};
  return Sphere{way, error, six_rounded / 6};
}

}  // namespace

Sphere sphere_of(const std::array<Point3, 4>& corners, double enough) {
  if (const auto sphere = estimated<double>(corners, enough)) return *sphere;
  if (const auto sphere = estimated<DoubleDouble>(corners, enough)) return *sphere;
  return exact_sphere(corners);
}

Spheres measure_spheres(std::span<const Point3> points,
                        std::span<const std::array<std::int32_t, 4>> tetrahedra, unsigned threads,
                        const base::Monitor& monitor) {
  Spheres result{base::LargeArray<Point3>(tetrahedra.size()), base::LargeArray<double>(tetrahedra.size())};
  base::for_items(tetrahedra.size(), tetrahedra_a_piece, threads, monitor, [&](std::size_t t) {
    const auto& [a, b, c, d] = tetrahedra[t];
    const Sphere sphere =
        sphere_of({points[base::at(a)], points[base::at(b)], points[base::at(c)], points[base::at(d)]});
    result.ways[t] = sphere.way;
    result.volumes[t] = sphere.volume;
  });
  return result;
}

}  // namespace vorotool::core::tetrahedra
