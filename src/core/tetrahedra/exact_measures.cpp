#include "core/tetrahedra/exact_measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/numbers/big_integer.hpp"
#include "core/numbers/dyadic_grid.hpp"
#include "core/numbers/fixed_integer.hpp"
#include "core/numbers/int128.hpp"
#include "core/numbers/rounded_quotient.hpp"
#include "core/numbers/sign.hpp"
#include "core/tetrahedra/predicates.hpp"

namespace vorotool::core::tetrahedra {

using numbers::BigInteger;
using numbers::DyadicGrid;
using numbers::FixedInteger;
using numbers::int128;
using numbers::OddMantissa;
using numbers::undecided;
using numbers::unit_roundoff;

namespace {

template <std::size_t n>
DyadicGrid grid_of(const std::array<Point3, n>& points) {
  std::array<double, 3 * n> values;
  for (std::size_t i = 0; i < n; ++i) {
    values[3 * i] = points[i].x, values[3 * i + 1] = points[i].y, values[3 * i + 2] = points[i].z;
  }
  return DyadicGrid(values);
}

// Coordinates have 64 limbs - 3 bits: their differences are below 2^m, m = 64 limbs - 2, sums of three squares of them
// below 2^(2 m + 2), minors below 2^(2 m + 1), and sums of three products of both below 2^(4 m + 5) = 2^(256 limbs - 3).
constexpr int spare_bits_of_measures = 3;

// Calls body(the number of limbs, a constant) with enough of them for coordinates of so many bits.
template <class Body>
auto with_limbs(int bits, const Body& body) {
  if (bits + spare_bits_of_measures <= 64) return body(std::integral_constant<std::size_t, 1>{});
  if (bits + spare_bits_of_measures <= 2 * 64) return body(std::integral_constant<std::size_t, 2>{});
  if (bits + spare_bits_of_measures <= 8 * 64) return body(std::integral_constant<std::size_t, 8>{});
  static_assert(2098 + spare_bits_of_measures <= 33 * 64);
  return body(std::integral_constant<std::size_t, 33>{});
}

// From the origin to the center of the sphere through it and three places, times `divisor`, which is twice six volumes.
template <class Number>
auto scaled_center(const Difference3<Number>& b, const Difference3<Number>& c, const Difference3<Number>& d) {
  const auto normal_b = cross(c, d), normal_c = cross(d, b), normal_d = cross(b, c);
  const auto bb = dot(b, b), cc = dot(c, c), dd = dot(d, d);
  using Value = decltype(bb * normal_b.x);
  struct {
    Difference3<Value> center;
    decltype(dot(b, normal_b)) six_volumes;
  } result{{bb * normal_b.x + cc * normal_c.x + dd * normal_d.x,
            bb * normal_b.y + cc * normal_c.y + dd * normal_d.y,
            bb * normal_b.z + cc * normal_c.z + dd * normal_d.z},
           dot(b, normal_b)};
  return result;
}

template <std::size_t limbs>
auto whole_differences(const DyadicGrid& grid, const Point3& from, const auto& points) {
  const auto of = [&](double value) { return grid.template fixed_integer<limbs>(value); };
  const auto x = of(from.x), y = of(from.y), z = of(from.z);
  std::array<Difference3<FixedInteger<limbs>>, std::tuple_size_v<std::decay_t<decltype(points)>>> result;
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = {of(points[i].x) - x, of(points[i].y) - y, of(points[i].z) - z};
  return result;
}

// The filter: |q - a|^2 - |q - b|^2 = (b.x - a.x) ((q.x - a.x) + (q.x - b.x)) and so on. A monomial meets six roundings,
// and the sum P of magnitudes as many: the error is at most P (6 u + 72 u^2). Products that underflow lose 3 h, h =
// 2^-1075, and the bound 2^-1020 6 u is worth more.
int order_by_filter(const Point3& q, const Point3& a, const Point3& b) {
  constexpr double factor = (6 + 256 * unit_roundoff) * unit_roundoff;
  const double x = b.x - a.x, y = b.y - a.y, z = b.z - a.z;
  const double ax = q.x - a.x, ay = q.y - a.y, az = q.z - a.z;
  const double bx = q.x - b.x, by = q.y - b.y, bz = q.z - b.z;
  const double difference = x * (ax + bx) + y * (ay + by) + z * (az + bz);
  const double permanent = std::abs(x) * (std::abs(ax) + std::abs(bx)) +
                           std::abs(y) * (std::abs(ay) + std::abs(by)) +
                           std::abs(z) * (std::abs(az) + std::abs(bz));
  return std::abs(difference) > factor * (permanent + 0x1p-1020) ? numbers::sign_of(difference) : undecided;
}

}  // namespace

Sphere exact_sphere(const std::array<Point3, 4>& corners) {
  const DyadicGrid grid = grid_of(corners);
  return with_limbs(grid.bits, [&](auto limbs) {
    const auto [b, c, d] =
        whole_differences<limbs.value>(grid, corners[0], std::array{corners[1], corners[2], corners[3]});
    const auto [center, six_volumes] = scaled_center(b, c, d);
    const auto quotient = [&grid, &divisor = six_volumes](const auto& value) {
      return numbers::rounded_quotient(value, divisor, grid.exponent - 1).value;
    };
    const Point3 way{quotient(center.x), quotient(center.y), quotient(center.z)};
    const double volume =
        numbers::rounded_quotient(six_volumes, FixedInteger<1>{{6}}, 3 * grid.exponent).value;
    // Half a unit in the last place of each coordinate, or of the smallest double.
    const double error = unit_roundoff * (std::abs(way.x) + std::abs(way.y) + std::abs(way.z)) + 0x1p-1073;
    return Sphere{way, error, volume};
  });
}

int compare_distances(const Point3& q, const Point3& a, const Point3& b) {
  if (const int sign = order_by_filter(q, a, b); sign != undecided) return sign;
  const DyadicGrid grid = grid_of(std::array{q, a, b});
  if (grid.bits <= 61) {  // differences are below 2^62, and sums of three squares below 2^126
    const auto square = [&](const Point3& p) {
      const auto of = [&](double from, double to) {
        const int128 difference = grid.integer(to) - grid.integer(from);
        return difference * difference;
      };
      return of(q.x, p.x) + of(q.y, p.y) + of(q.z, p.z);
    };
    const int128 order = square(a) - square(b);
    return (order > 0) - (order < 0);
  }
  return with_limbs(grid.bits, [&](auto limbs) {
    const auto [to_a, to_b] = whole_differences<limbs.value>(grid, q, std::array{a, b});
    return (dot(to_a, to_a) - dot(to_b, to_b)).sign();
  });
}

namespace {

BigInteger magnitude(BigInteger value) {
  if (value.sign() < 0) value.negate();
  return value;
}

BigInteger norm(const Difference3<BigInteger>& p) { return magnitude(p.x) + magnitude(p.y) + magnitude(p.z); }

// numerator / denominator, rounded towards zero; the denominator is positive. Each step takes 29 bits or more off.
BigInteger quotient(const BigInteger& numerator, const BigInteger& denominator) {
  BigInteger rest = magnitude(numerator), result;
  while (compare(rest, denominator) >= 0) {
    // At most the quotient of the leading bits times 2^32.
    const std::uint64_t digits = (rest.leading_bits() >> 1) / ((denominator.leading_bits() >> 33) + 1);
    const int shift = static_cast<int>(rest.bits()) - static_cast<int>(denominator.bits()) - 32;
    const std::uint64_t whole = std::max<std::uint64_t>(shift < 0 ? digits >> -shift : digits, 1);
    const BigInteger part = BigInteger(int128{whole}) << std::max(shift, 0);
    rest -= part * denominator;
    result += part;
  }
  if (numerator.sign() < 0) result.negate();
  return result;
}

// The cell in a lattice of all the coordinates. Centers are rounded to 2^-fraction of its step.
class WholeCell {
 public:
  WholeCell(const Point3& site, std::span<const std::array<Point3, 3>> ends, std::span<const CellEdge> edges)
      : site_(site), ends_(ends), edges_(edges) {
    look(site);
    for (const auto& corners : ends)
      std::for_each(corners.begin(), corners.end(), [this](const Point3& p) { look(p); });
  }

  double volume() {
    for (int fraction = 64; fraction <= most_fraction; fraction *= 2) {
      if (!round_centers(fraction)) break;
      const auto [twelve_volumes, error] = sum();
      if (compare(error << 54, twelve_volumes) <= 0)
        return scaled(twelve_volumes, 3 * exponent_ - 2 * fraction);
    }
    return std::numeric_limits<double>::quiet_NaN();  // these are no tetrahedra of a Delaunay triangulation
  }

 private:
  static constexpr int most_fraction = 1 << 13;  // the lattice has up to 2098 bits

  struct Sum {
    BigInteger twelve_volumes, error;
  };

  void look(const Point3& p) {
    for (const double value : {p.x, p.y, p.z}) {
      const OddMantissa parts(value);
      if (parts.mantissa != 0) exponent_ = std::min(exponent_, parts.exponent);
    }
  }

  BigInteger whole(double value) const {
    const OddMantissa parts(value);
    if (parts.mantissa == 0) return {};
    const int128 mantissa = static_cast<int128>(parts.mantissa);
    return BigInteger(parts.is_negative ? -mantissa : mantissa) << (parts.exponent - exponent_);
  }

  Difference3<BigInteger> way(const Point3& from, const Point3& to) const {
    return {whole(to.x) - whole(from.x), whole(to.y) - whole(from.y), whole(to.z) - whole(from.z)};
  }

  // False where a tetrahedron is not positive.
  bool round_centers(int fraction) {
    centers_.clear();
    for (const auto& [b, c, d] : ends_) {
      const auto [center, six_volumes] = scaled_center(way(site_, b), way(site_, c), way(site_, d));
      if (six_volumes.sign() <= 0) return false;
      const auto rounded = [fraction, &divisor = six_volumes](const BigInteger& value) {
        return quotient(value << (fraction - 1), divisor);
      };
      centers_.push_back({rounded(center.x), rounded(center.y), rounded(center.z)});
    }
    return true;
  }

  // Each coordinate of a center errs by less than 1: those of the cross product of p and q, by |p| + |q| + 2 at most.
  Sum sum() const {
    Sum result;
    for (const CellEdge& edge : edges_) {
      const auto &p = centers_[edge.first], &q = centers_[edge.second];
      const auto side = way(edge.b, edge.c);
      result.twelve_volumes += dot(cross(p, q), side);
      result.error += (norm(p) + norm(q) + BigInteger(2)) * norm(side);
    }
    return result;
  }

  // value 2^exponent / 12, of what is not negative.
  static double scaled(const BigInteger& value, int exponent) {
    if (value.sign() <= 0) return 0;
    const int shift = static_cast<int>(value.bits()) - 64;
    return std::ldexp(static_cast<double>(value.leading_bits()) / 12, exponent + shift);
  }

  const Point3& site_;
  std::span<const std::array<Point3, 3>> ends_;
  std::span<const CellEdge> edges_;
  int exponent_ = 1024;
  std::vector<Difference3<BigInteger>> centers_;
};

}  // namespace

double exact_cell_volume(const Point3& site, std::span<const std::array<Point3, 3>> ends,
                         std::span<const CellEdge> edges) {
  return WholeCell(site, ends, edges).volume();
}

}  // namespace vorotool::core::tetrahedra
