#include "core/cells_in_space/cell_planes.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "core/numbers/double_double.hpp"
#include "core/numbers/dyadic_grid.hpp"
#include "core/numbers/fixed_integer.hpp"
#include "core/numbers/sign.hpp"

namespace vorotool::core::cells_in_space {

using numbers::DoubleDouble;
using numbers::DyadicGrid;
using numbers::FixedInteger;
using numbers::Rounded;
using numbers::two_difference;
using numbers::undecided;
using numbers::unit_roundoff;

namespace {

using Triple = std::array<std::int32_t, 3>;

// Four factors of such magnitudes, of which one may be squared, lie between 2^-600 and 2^600, and the bounds of their
// errors above 2^-710: nothing underflows or overflows.
bool is_moderate_number(double value) {
  const double magnitude = std::abs(value);
  return magnitude == 0 || (magnitude >= 0x1p-120 && magnitude <= 0x1p120);
}

// The filter. A term of n v - d, homogeneous, meets 17 roundings: three of differences, five of a half square of a
// distance (its two differences, product and two sums), two of a minor, three of a determinant of three, the last
// product and three sums. So do the sums of the absolute terms; k = 17 u + 4 17^2 u^2 is enough (as in
// core/tetrahedra/predicates.cpp).
constexpr double side_factor = (17 + 2048 * unit_roundoff) * unit_roundoff;
// A term of w alone meets eight.
constexpr double determinant_factor = (8 + 256 * unit_roundoff) * unit_roundoff;

template <class Number>
struct Vector {
  Number x, y, z;
};

template <class Number>
auto cross(const Vector<Number>& a, const Vector<Number>& b) {
  using Product = decltype(a.x * b.y);
  return Vector<Product>{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

constexpr auto cross_of = [](const auto& a, const auto& b) { return cross(a, b); };

// The sums of absolute terms.
Vector<double> cross_size(const Vector<double>& a, const Vector<double>& b) {
  const auto sum = [](double p, double q) { return std::abs(p) + std::abs(q); };
  return {sum(a.y * b.z, a.z * b.y), sum(a.z * b.x, a.x * b.z), sum(a.x * b.y, a.y * b.x)};
}

template <class A, class B>
auto dot(const Vector<A>& a, const Vector<B>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// The point where three planes n v = d meet, times w, and w = det(n).
template <class W, class X>
struct Homogeneous {
  W w;
  Vector<X> x;
};

template <class Normal, class Distance, class Cross>
auto solved(const std::array<Vector<Normal>, 3>& n, const std::array<Distance, 3>& d, const Cross& cross_of) {
  const auto a = cross_of(n[1], n[2]), b = cross_of(n[2], n[0]), c = cross_of(n[0], n[1]);
  const auto along = [&](const auto& p, const auto& q, const auto& r) {
    return d[0] * p + d[1] * q + d[2] * r;
  };
  using X = decltype(along(a.x, b.x, c.x));
  using W = decltype(dot(n[0], a));
  return Homogeneous<W, X>{dot(n[0], a), {along(a.x, b.x, c.x), along(a.y, b.y, c.y), along(a.z, b.z, c.z)}};
}

// Of numbers in 106 bits: X = sum of d (n x n) has terms with products of relative errors 8 u^2 each, squares 8 + 8,
// sums 4 each, in all below 64 u^2, w fewer; the quotient q of them, where the error of w is below |w| 2^-20, has at
// most 64 u^2 (x_size + |q| w_size) (1 + 2^-19) / w + 16 u^2 |q|, and the site added 4 u^2 of the sum. 96 u^2 makes up
// for the roundings of the bound.
constexpr double u2 = unit_roundoff * unit_roundoff;

std::optional<Rounded> rounded(double origin, const DoubleDouble& x, double x_size, const DoubleDouble& w,
                               double w_size) {
  if (!(w.head > 0x1p20 * 64 * u2 * w_size)) return {};
  const DoubleDouble quotient = x / w;
  const DoubleDouble sum = DoubleDouble(origin) + quotient;
  const double error = 96 * u2 * ((x_size + std::abs(quotient.head) * w_size) / w.head + std::abs(sum.head));
  const double nearest = sum.head + (sum.tail - error);
  if (!(nearest == sum.head + (sum.tail + error))) return {};
  const double rest = (sum.head - nearest) + sum.tail;
  return Rounded{nearest, std::abs(rest) > 2 * error ? numbers::sign_of(rest) : undecided};
}

// The coordinates are below 2^b, b <= 64 limbs - 4: differences, twice them, squares of distances, minors, w, what is
// solved for and n v - d are below 2^(b + 1), 2^(b + 2), 2^(2 b + 4), 2^(2 b + 5), 2^(3 b + 9), 2^(4 b + 12) and
// 2^(5 b + 15), which leaves room for the sign in 1, 1, 2, 2, 3, 4 and 5 times as many limbs, and three bits of w and of
// what is solved for, as numbers::rounded_quotient wants.
constexpr int spare_bits = 4;

}  // namespace

// Some planes and the site in integers of one lattice.
template <std::size_t n>
class CellPlanes::Integers {
 public:
  Integers(const CellPlanes& cell, const std::array<std::int32_t, n>& planes)
      : planes_(planes), values_(values_of(cell, planes)), grid_(values_) {}

  int determinant_sign() const {
    return with_limbs([this]<std::size_t limbs>() {
      const auto [normal, distance] = this->template rows<limbs>();
      return dot(normal[0], cross(normal[1], normal[2])).sign();
    });
  }

  // Of the fourth plane, where the other three meet; their determinant is positive.
  int side() const {
    return with_limbs([this]<std::size_t limbs>() {
      const auto [normal, distance] = this->template rows<limbs>();
      const auto [w, x] = solve<limbs>(normal, distance);
      return (distance[3] * w - dot(normal[3], x)).sign();
    });
  }

  RoundedPlace place() const {
    return with_limbs([this]<std::size_t limbs>() {
      const auto [normal, distance] = this->template rows<limbs>();
      const auto [w, x] = solve<limbs>(normal, distance);
      const auto coordinate = [this, &divisor = w](std::size_t axis, const FixedInteger<4 * limbs>& along) {
        const auto origin = grid_.template fixed_integer<limbs>(values_[axis]);
        return numbers::rounded_quotient(origin * divisor + along, divisor, grid_.exponent);
      };
      return RoundedPlace{coordinate(0, x.x), coordinate(1, x.y), coordinate(2, x.z)};
    });
  }

 private:
  static std::array<double, 3 * n + 3> values_of(const CellPlanes& cell,
                                                 const std::array<std::int32_t, n>& planes) {
    std::array<double, 3 * n + 3> values{cell.site_.x, cell.site_.y, cell.site_.z};
    for (std::size_t i = 0; i < n; ++i) {
      const auto plane = static_cast<std::size_t>(planes[i]);
      const Point3& other = cell.rows_[plane].other;
      values[3 * i + 3] = plane < box_sides ? cell.side_value(plane) : other.x;
      values[3 * i + 4] = plane < box_sides ? 0 : other.y;
      values[3 * i + 5] = plane < box_sides ? 0 : other.z;
    }
    return values;
  }

  auto with_limbs(const auto& call) const {
    const int bits = grid_.bits + spare_bits;
    if (bits <= 64) return call.template operator()<1>();
    if (bits <= 2 * 64) return call.template operator()<2>();
    if (bits <= 4 * 64) return call.template operator()<4>();
    if (bits <= 8 * 64) return call.template operator()<8>();
    if (bits <= 16 * 64) return call.template operator()<16>();
    static_assert(2098 + spare_bits <= 33 * 64);
    return call.template operator()<33>();
  }

  template <std::size_t limbs>
  auto rows() const {
    using One = FixedInteger<limbs>;
    const auto value = [this](std::size_t i) { return grid_.template fixed_integer<limbs>(values_[i]); };
    std::pair<std::array<Vector<One>, n>, std::array<FixedInteger<2 * limbs>, n>> result;
    for (std::size_t i = 0; i < n; ++i) {
      const auto plane = static_cast<std::size_t>(planes_[i]);
      Vector<One>& normal = result.first[i];
      if (plane < box_sides) {
        const std::size_t axis = plane / 2;
        const One one{{1}};
        const One unit = plane % 2 == 1 ? one : One{} - one;
        (axis == 0 ? normal.x : axis == 1 ? normal.y : normal.z) = unit;
        result.second[i] = (value(3 * i + 3) - value(axis)) * unit;
      } else {
        const Vector<One> way{value(3 * i + 3) - value(0), value(3 * i + 4) - value(1),
                              value(3 * i + 5) - value(2)};
        normal = {way.x + way.x, way.y + way.y, way.z + way.z};
        result.second[i] = dot(way, way);
      }
    }
    return result;
  }

  template <std::size_t limbs>
  static auto solve(const std::array<Vector<FixedInteger<limbs>>, n>& normal,
                    const std::array<FixedInteger<2 * limbs>, n>& distance) {
    return solved(std::array{normal[0], normal[1], normal[2]},
                  std::array{distance[0], distance[1], distance[2]}, cross_of);
  }

  std::array<std::int32_t, n> planes_;
  std::array<double, 3 * n + 3> values_;
  DyadicGrid grid_;
};

double CellPlanes::side_value(std::size_t plane) const {
  const Point3& corner = plane % 2 == 0 ? box_.low : box_.high;
  return plane / 2 == 0 ? corner.x : plane / 2 == 1 ? corner.y : corner.z;
}

void CellPlanes::begin(const Point3& site) {
  site_ = site;
  rows_.clear();
  for (std::size_t plane = 0; plane < box_sides; ++plane) {
    const std::size_t axis = plane / 2;
    const double unit = plane % 2 == 1 ? 1 : -1;
    const double from = axis == 0 ? site.x : axis == 1 ? site.y : site.z;
    const double d = (side_value(plane) - from) * unit;
    rows_.push_back(
        {axis == 0 ? unit : 0, axis == 1 ? unit : 0, axis == 2 ? unit : 0, d, is_moderate_number(d), {}});
  }
}

std::int32_t CellPlanes::add_bisector(const Point3& other) {
  const double x = other.x - site_.x, y = other.y - site_.y, z = other.z - site_.z;
  const bool is_moderate = is_moderate_number(x) && is_moderate_number(y) && is_moderate_number(z);
  rows_.push_back({x, y, z, (x * x + y * y + z * z) / 2, is_moderate, other});
  return static_cast<std::int32_t>(rows_.size()) - 1;
}

bool CellPlanes::is_moderate(const Triple& planes) const {
  return row(planes[0]).is_moderate && row(planes[1]).is_moderate && row(planes[2]).is_moderate;
}

Meeting CellPlanes::meeting(Triple planes) const {
  std::array<Vector<double>, 3> normal, normal_size;
  std::array<double, 3> distance, distance_size;
  for (std::size_t i = 0; i < 3; ++i) {
    const Row& r = row(planes[i]);
    normal[i] = {r.x, r.y, r.z};
    normal_size[i] = {std::abs(r.x), std::abs(r.y), std::abs(r.z)};
    distance[i] = r.d, distance_size[i] = std::abs(r.d);
  }
  auto [w, x] = solved(normal, distance, cross_of);
  const auto [w_size, x_size] = solved(normal_size, distance_size, cross_size);
  const bool is_clear = is_moderate(planes) && std::abs(w) > determinant_factor * w_size;
  const int sign = is_clear ? numbers::sign_of(w) : Integers<3>(*this, planes).determinant_sign();
  if (sign < 0) {
    std::swap(planes[1], planes[2]);
    w = -w, x = {-x.x, -x.y, -x.z};
  }
  return {planes, x.x, x.y, x.z, w, x_size.x, x_size.y, x_size.z, w_size};
}

int CellPlanes::side(const Meeting& point, std::int32_t plane) const {
  const Row& r = row(plane);
  const double value = r.d * point.w - (r.x * point.x + r.y * point.y + r.z * point.z);
  const double size = std::abs(r.d) * point.w_size + std::abs(r.x) * point.x_size +
                      std::abs(r.y) * point.y_size + std::abs(r.z) * point.z_size;
  const bool is_clear = std::abs(value) > side_factor * size && r.is_moderate && is_moderate(point.planes);
  if (is_clear) return numbers::sign_of(value);
  return Integers<4>(*this, {point.planes[0], point.planes[1], point.planes[2], plane}).side();
}

RoundedPlace CellPlanes::place(const Triple& planes) const {
  if (!is_moderate(planes)) return place_exactly(planes);
  const Meeting sizes = meeting(planes);
  std::array<Vector<DoubleDouble>, 3> normal;
  std::array<DoubleDouble, 3> distance;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto plane = static_cast<std::size_t>(sizes.planes[i]);
    const Row& r = rows_[plane];
    if (plane < box_sides) {
      const double from = plane / 2 == 0 ? site_.x : plane / 2 == 1 ? site_.y : site_.z;
      const DoubleDouble way = two_difference(side_value(plane), from);
      normal[i] = {r.x, r.y, r.z};
      distance[i] = plane % 2 == 1 ? way : -way;
    } else {
      normal[i] = {two_difference(r.other.x, site_.x), two_difference(r.other.y, site_.y),
                   two_difference(r.other.z, site_.z)};
      const DoubleDouble square = dot(normal[i], normal[i]);
      distance[i] = {square.head / 2, square.tail / 2};
    }
  }
  const auto [w, v] = solved(normal, distance, cross_of);
  const auto x = rounded(site_.x, v.x, sizes.x_size, w, sizes.w_size);
  const auto y = rounded(site_.y, v.y, sizes.y_size, w, sizes.w_size);
  const auto z = rounded(site_.z, v.z, sizes.z_size, w, sizes.w_size);
  return x && y && z ? RoundedPlace{*x, *y, *z} : place_exactly(planes);
}

RoundedPlace CellPlanes::place_exactly(const Triple& planes) const {
  return Integers<3>(*this, meeting(planes).planes).place();
}

}  // namespace vorotool::core::cells_in_space
