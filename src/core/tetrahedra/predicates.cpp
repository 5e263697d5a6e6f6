#include "core/tetrahedra/predicates.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/numbers/dyadic_grid.hpp"
#include "core/numbers/fixed_integer.hpp"
#include "core/numbers/int128.hpp"
#include "core/tetrahedra/filter_bounds.hpp"

namespace vorotool::core::tetrahedra {

using numbers::DyadicGrid;
using numbers::FixedInteger;
using numbers::int128;
using numbers::undecided;

namespace {

double absolute_minor(const Difference3<double>& a, const Difference3<double>& b) {
  return std::abs(a.x * b.y) + std::abs(b.x * a.y);
}

double orient_permanent(const std::array<Difference3<double>, 3>& p) {
  const auto& [a, b, c] = p;
  const double za = std::abs(a.z), zb = std::abs(b.z), zc = std::abs(c.z);
  return za * absolute_minor(b, c) + zb * absolute_minor(c, a) + zc * absolute_minor(a, b) +
         orient_guard * (1 + za + zb + zc);
}

double sphere_permanent(const std::array<Difference3<double>, 4>& p) {
  const auto& [a, b, c, d] = p;
  const auto lift = [](const Difference3<double>& v) { return v.x * v.x + v.y * v.y + v.z * v.z; };
  const double za = std::abs(a.z), zb = std::abs(b.z), zc = std::abs(c.z), zd = std::abs(d.z);
  const double ab = absolute_minor(a, b), bc = absolute_minor(b, c), cd = absolute_minor(c, d);
  const double da = absolute_minor(d, a), ac = absolute_minor(a, c), bd = absolute_minor(b, d);
  if (!(std::max(std::max(lift(a), lift(b)), std::max(lift(c), lift(d))) <= largest_lift))
    return std::numeric_limits<double>::infinity();
  return lift(d) * (za * bc + zb * ac + zc * ab) + lift(a) * (zb * cd + zc * bd + zd * bc) +
         lift(b) * (zc * da + zd * ac + za * cd) + lift(c) * (zd * ab + za * bd + zb * da) + sphere_guard;
}

int sign_of(int128 value) { return (value > 0) - (value < 0); }
int sign_of(const auto& value) { return value.sign(); }

int determinant_sign(const auto& differences) {
  if constexpr (std::tuple_size_v<std::decay_t<decltype(differences)>> == 3) {
    return sign_of(orient3d_determinant(differences));
  } else {
    return sign_of(in_sphere_determinant(differences));
  }
}

// Integers. A determinant of differences below 2^m has magnitude below 6 2^(3 m) for orient3d, below 72 2^(5 m) for
// in_sphere; intermediate results are smaller.
constexpr int orient_bits_128 = 41;  // 3 * 41 + 3 <= 126
constexpr int sphere_bits_128 = 24;  // 5 * 24 + 7 <= 127
// In limbs of 64 bits minors of two differences have twice as many, cofactors three times, lifts twice, the results
// three or five times: below 2^(2 m + 1), 2^(3 m + 3), 2^(2 m + 2), 2^(5 m + 7), which leaves room for the sign where
// m <= 64 limbs - 2, as 5 (64 limbs - 2) + 7 = 320 limbs - 3.
constexpr int word_bits = 61;  // of coordinates: their differences are below 2^62
constexpr int spare_bits = 3;  // of limbs, for coordinates

// n points; the last is what the others are seen from.
template <std::size_t n>
class IntegerCall {
 public:
  explicit IntegerCall(const std::array<const Point3*, n>& points)
      : values_(values_of(points)), lattice_(values_) {}

  int sign() const { return lattice_.bits <= word_bits ? word_sign() : wide_sign(); }

  int wide_sign() const {
    const int bits = lattice_.bits + spare_bits;
    if (bits <= 2 * 64) return sign_in_limbs<2>();
    if (bits <= 4 * 64) return sign_in_limbs<4>();
    if (bits <= 8 * 64) return sign_in_limbs<8>();
    if (bits <= 16 * 64) return sign_in_limbs<16>();
    static_assert(2098 + spare_bits <= 33 * 64);
    return sign_in_limbs<33>();
  }

 private:
  static constexpr std::size_t rows = n - 1;

  static std::array<double, 3 * n> values_of(const std::array<const Point3*, n>& points) {
    std::array<double, 3 * n> values;
    for (std::size_t i = 0; i < n; ++i) {
      values[3 * i] = points[i]->x, values[3 * i + 1] = points[i]->y, values[3 * i + 2] = points[i]->z;
    }
    return values;
  }

  int word_sign() const {
    std::array<std::int64_t, 3 * n> whole;
    for (std::size_t i = 0; i < 3 * n; ++i) whole[i] = lattice_.integer(values_[i]);
    std::array<Difference3<std::int64_t>, rows> p;
    std::uint64_t magnitudes = 0;
    const auto less_last = [&](std::size_t i, std::size_t axis) {
      const std::int64_t difference = whole[3 * i + axis] - whole[3 * rows + axis];
      magnitudes |= static_cast<std::uint64_t>(difference < 0 ? -difference : difference);
      return difference;
    };
    for (std::size_t i = 0; i < rows; ++i) p[i] = {less_last(i, 0), less_last(i, 1), less_last(i, 2)};
    if (std::bit_width(magnitudes) <= (n == 4 ? orient_bits_128 : sphere_bits_128)) {
      return determinant_sign(converted<int128>(p, [](std::int64_t v) { return int128{v}; }));
    }
    return determinant_sign(converted<FixedInteger<1>>(
        p, [](std::int64_t v) { return FixedInteger<1>{{static_cast<std::uint64_t>(v)}}; }));
  }

  template <class Number>
  static auto converted(const std::array<Difference3<std::int64_t>, rows>& p, const auto& as_number) {
    std::array<Difference3<Number>, rows> result;
    for (std::size_t i = 0; i < rows; ++i)
      result[i] = {as_number(p[i].x), as_number(p[i].y), as_number(p[i].z)};
    return result;
  }

  template <std::size_t limbs>
  int sign_in_limbs() const {
    std::array<FixedInteger<limbs>, 3 * n> whole;
    for (std::size_t i = 0; i < 3 * n; ++i) whole[i] = lattice_.template fixed_integer<limbs>(values_[i]);
    std::array<Difference3<FixedInteger<limbs>>, rows> p;
    for (std::size_t i = 0; i < rows; ++i) {
      p[i] = {whole[3 * i] - whole[3 * rows], whole[3 * i + 1] - whole[3 * rows + 1],
              whole[3 * i + 2] - whole[3 * rows + 2]};
    }
    return determinant_sign(p);
  }

  std::array<double, 3 * n> values_;
  DyadicGrid lattice_;
};

// The sign of a tie, with the orientation of the caller's choice.
template <class Orient>
int sign_of_tie(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& e,
                const Orient& orient) {
  // The determinant is the sum of the heights, each times the orientation of the other four with the sign that makes
  // that of e negative: a point that is lowered goes inside. Lowering turns the signs of the cofactors.
  std::array<const Point3*, 5> order{&a, &b, &c, &d, &e};
  std::sort(order.begin(), order.end(),
            [](const Point3* p, const Point3* q) { return comes_before(*p, *q); });
  for (const Point3* p : order) {
    int sign = 0;
    if (p == &e) sign = orient(a, b, c, d);
    if (p == &a) sign = -orient(e, b, c, d);
    if (p == &b) sign = -orient(a, e, c, d);
    if (p == &c) sign = -orient(a, b, e, d);
    if (p == &d) sign = -orient(a, b, c, e);
    if (sign != 0) return sign;
  }
  return 0;
}

}  // namespace

int orient3d_filter(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  const auto p = differences(d, a, b, c);
  const double value = orient3d_determinant(p);
  return std::abs(value) > orient_factor * orient_permanent(p) ? numbers::sign_of(value) : undecided;
}

int in_sphere_filter(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& e) {
  const auto p = differences(e, a, b, c, d);
  const double value = in_sphere_determinant(p);
  return std::abs(value) > sphere_factor * sphere_permanent(p) ? numbers::sign_of(value) : undecided;
}

int orient3d_integers(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return IntegerCall<4>({&a, &b, &c, &d}).sign();
}

int orient3d_wide(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return IntegerCall<4>({&a, &b, &c, &d}).wide_sign();
}

int in_sphere_integers(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& e) {
  return IntegerCall<5>({&a, &b, &c, &d, &e}).sign();
}

int in_sphere_wide(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& e) {
  return IntegerCall<5>({&a, &b, &c, &d, &e}).wide_sign();
}

int orient3d(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  const int sign = orient3d_filter(a, b, c, d);
  return sign != undecided ? sign : orient3d_integers(a, b, c, d);
}

int in_sphere(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& e) {
  const int sign = in_sphere_filter(a, b, c, d, e);
  return sign != undecided ? sign : in_sphere_integers(a, b, c, d, e);
}

int tie_sign(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& e) {
  return sign_of_tie(a, b, c, d, e, orient3d);
}

int in_sphere_or_tie(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& e) {
  const int sign = in_sphere(a, b, c, d, e);
  return sign != 0 ? sign : tie_sign(a, b, c, d, e);
}

Point3 extent_of(std::span<const Point3> points) {
  if (points.empty()) return {0, 0, 0};
  Point3 least = points[0], most = points[0];
  for (const Point3& p : points) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
  }
  return {most.x - least.x, most.y - least.y, most.z - least.z};
}

void move_to_integers(std::span<Point3> points) {
  if (points.empty()) return;
  Point3 least = points[0];
  int exponent = 1024;
  const auto look = [&](double value, double& smallest) {
    smallest = std::min(smallest, value);
    const numbers::OddMantissa parts(value);
    if (parts.mantissa != 0) exponent = std::min(exponent, parts.exponent);
  };
  for (const Point3& p : points) look(p.x, least.x), look(p.y, least.y), look(p.z, least.z);
  if (exponent == 1024) return;  // all are 0
  const auto [x, y, z] = extent_of(points);
  if (!(std::max({x, y, z}) < std::ldexp(1.0, exponent + 52))) return;
  // Differences of multiples of 2^exponent below 2^(exponent + 53) are doubles, and so is the scaling.
  const auto moved = [&](double value, double from) { return std::ldexp(value - from, -exponent); };
  for (Point3& p : points) p = {moved(p.x, least.x), moved(p.y, least.y), moved(p.z, least.z)};
}

}  // namespace vorotool::core::tetrahedra
