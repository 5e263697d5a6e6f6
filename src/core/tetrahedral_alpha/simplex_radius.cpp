#include "core/tetrahedral_alpha/simplex_radius.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "core/alpha/exact_radius.hpp"
#include "core/alpha/radius_ranks.hpp"
#include "core/numbers/big_integer.hpp"
#include "core/numbers/double_double.hpp"
#include "core/numbers/dyadic_grid.hpp"
#include "core/numbers/fixed_integer.hpp"
#include "core/numbers/int128.hpp"
#include "core/numbers/sign.hpp"
#include "core/tetrahedral_alpha/edge_stars.hpp"
#include "core/tetrahedral_alpha/radius_bounds.hpp"

namespace vorotool::core::tetrahedral_alpha {

using alpha::rounded_by;
using alpha::SquaredRadius;
using numbers::BigInteger;
using numbers::DoubleDouble;
using numbers::DyadicGrid;
using numbers::FixedInteger;
using numbers::int128;
using namespace bounds;

namespace {

static_assert(u == numbers::unit_roundoff);

// ---- formulas, for numbers of any type; products of integers of fixed width are wider ----
template <class Number>
struct Vector {
  Number x, y, z;
};

template <class Number>
Vector<Number> minus(const Vector<Number>& p, const Vector<Number>& q) {
  return {p.x - q.x, p.y - q.y, p.z - q.z};
}

template <class P, class Q>
auto dot(const Vector<P>& p, const Vector<Q>& q) {
  return p.x * q.x + p.y * q.y + p.z * q.z;
}

template <class Number>
auto cross(const Vector<Number>& p, const Vector<Number>& q) {
  using Product = decltype(p.x * q.x);
  return Vector<Product>{p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

template <class Factor, class Number>
auto times(const Factor& factor, const Vector<Number>& p) {
  using Product = decltype(factor * p.x);
  return Vector<Product>{factor * p.x, factor * p.y, factor * p.z};
}

template <class Number>
Vector<Number> sum_of(const Vector<Number>& p, const Vector<Number>& q, const Vector<Number>& r) {
  return {p.x + q.x + r.x, p.y + q.y + r.y, p.z + q.z + r.z};
}

// Of a tetrahedron with a corner at 0: the normals of the facets there, the determinant, and its double times the
// center of the sphere.
template <class Number>
struct Sphere {
  using Second = decltype(Number{} * Number{});
  using Third = decltype(Number{} * Second{});
  using Fourth = decltype(Second{} * Second{});

  std::array<Vector<Second>, 3> normal;
  Third determinant;
  Vector<Fourth> center;

  Sphere(const Vector<Number>& b, const Vector<Number>& c, const Vector<Number>& d)
      : normal{cross(c, d), cross(d, b), cross(b, c)},
        determinant(dot(b, normal[0])),
        center(
            sum_of(times(dot(b, b), normal[0]), times(dot(c, c), normal[1]), times(dot(d, d), normal[2]))) {}

  // The center on the inner side of each facet, opposite to 0, b, c and d: the barycentric coordinates of the center,
  // times a positive number.
  auto heights() const {
    const auto first = dot(center, normal[0]), second = dot(center, normal[1]),
               third = dot(center, normal[2]);
    const auto square = determinant * determinant;
    return std::array{square + square - (first + second + third), first, second, third};
  }
};

template <class Number>
auto four_times(const Number& value) {
  const Number twice = value + value;
  return twice + twice;
}

// ---- estimates ----
// Within `error` of the radius, relative to it; not known where that is infinite.
struct Estimate {
  double radius, error;
};
constexpr Estimate unknown{0, infinity};
constexpr double worst_refined = 0x1p-8;  // of an estimate, so that its own bound is right within as much

Vector<double> from_to(const Point3& a, const Point3& b) { return {b.x - a.x, b.y - a.y, b.z - a.z}; }

Vector<double> absolute(const Vector<double>& p) { return {std::abs(p.x), std::abs(p.y), std::abs(p.z)}; }

Vector<double> permanents(const Vector<double>& p, const Vector<double>& q) {
  return {p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x};
}

double extent(const Vector<double>& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

template <class... Vectors>
bool are_in_range(const Vectors&... vectors) {
  const double size = std::max({extent(vectors)...});
  return size >= smallest && size <= largest;
}

Estimate estimate_edge(const Simplex& s) {
  const Vector<double> way = from_to(*s.corner[0], *s.corner[1]);
  if (!are_in_range(way)) return unknown;
  return {std::sqrt(dot(way, way)) / 2, few_roundings};
}

// R^2 = |ab|^2 |ac|^2 |bc|^2 / (4 |ab x ac|^2).
Estimate estimate_triangle(const Simplex& s) {
  const Vector<double> b = from_to(*s.corner[0], *s.corner[1]), c = from_to(*s.corner[0], *s.corner[2]);
  const Vector<double> third = from_to(*s.corner[1], *s.corner[2]);
  if (!are_in_range(b, c)) return unknown;
  const Vector<double> normal = cross(b, c), terms = permanents(absolute(b), absolute(c));
  const double square = dot(normal, normal);
  if (!(square >= least_determinant)) return unknown;
  const double spread = std::sqrt(dot(terms, terms) / square);
  return {std::sqrt(dot(b, b) * dot(c, c) * dot(third, third) / (4 * square)),
          normal_error * spread + 2 * few_roundings};
}

struct TetrahedronEstimate {
  Estimate radius;
  Sphere<double> sphere;
  std::array<double, 4> doubts;  // bounds of the errors of the heights; 0 where they are exact
};

TetrahedronEstimate estimate_tetrahedron(const Simplex& s, bool are_integers) {
  const Vector<double> b = from_to(*s.corner[0], *s.corner[1]), c = from_to(*s.corner[0], *s.corner[2]),
                       d = from_to(*s.corner[0], *s.corner[3]);
  TetrahedronEstimate found{unknown, Sphere<double>(b, c, d), {infinity, infinity, infinity, infinity}};
  const Sphere<double>& sphere = found.sphere;
  const double determinant = std::abs(sphere.determinant);
  if (!are_in_range(b, c, d) || !(determinant >= least_determinant)) return found;
  const Vector<double> pb = absolute(b), pc = absolute(c), pd = absolute(d);
  const std::array<Vector<double>, 3> terms{permanents(pc, pd), permanents(pd, pb), permanents(pb, pc)};
  const double determinant_terms = dot(pb, terms[0]);
  const Vector<double> center_terms =
      sum_of(times(dot(b, b), terms[0]), times(dot(c, c), terms[1]), times(dot(d, d), terms[2]));
  std::array<double, 4> height_terms{0, dot(center_terms, terms[0]), dot(center_terms, terms[1]),
                                     dot(center_terms, terms[2])};
  height_terms[0] =
      2 * determinant_terms * determinant_terms + height_terms[1] + height_terms[2] + height_terms[3];
  for (std::size_t k = 0; k < 4; ++k) {
    const bool is_exact = are_integers && height_terms[0] < exact_limit;
    found.doubts[k] = is_exact ? 0 : height_error * height_terms[k] + height_guard;
  }
  const double square = dot(sphere.center, sphere.center);
  const double spread = std::sqrt(dot(center_terms, center_terms) / square);
  found.radius = {
      std::sqrt(square / (4 * determinant * determinant)),
      center_error * spread + determinant_error * (determinant_terms / determinant) + few_roundings};
  return found;
}

Estimate estimate(const Simplex& s, bool are_integers) {
  if (s.size == 2) return estimate_edge(s);
  return s.size == 3 ? estimate_triangle(s) : estimate_tetrahedron(s, are_integers).radius;
}

// ---- integers ----
//
// With differences below 2^m the numerators are below 2^(8 m + 10) and the denominators below 2^(6 m + 8): those of
// tetrahedra, whose determinants are below 6 2^(3 m), and centers below 18 2^(4 m) in each coordinate.
constexpr double most_short =
    128;                       // 2^7: numerators below 2^66, denominators below 2^50, products below 2^116
constexpr int word_bits = 61;  // of coordinates; their differences have 62, and 8 * 62 + 10 <= 8 * 64 - 2

struct WordSquare {
  FixedInteger<8> numerator;
  FixedInteger<6> denominator;

  template <std::size_t n, std::size_t d>
  static WordSquare of(const FixedInteger<n>& numerator, const FixedInteger<d>& denominator) {
    WordSquare result;
    std::copy(numerator.limb.begin(), numerator.limb.end(), result.numerator.limb.begin());
    std::copy(denominator.limb.begin(), denominator.limb.end(), result.denominator.limb.begin());
    return result;
  }
};

struct WideSquare {
  BigInteger numerator, denominator;

  static WideSquare of(const BigInteger& n, const BigInteger& d) { return {n, d}; }
};

struct FineSquare {
  DoubleDouble numerator, denominator;

  static FineSquare of(const DoubleDouble& n, const DoubleDouble& d) { return {n, d}; }
};

// Numbers whose squares are as wide as need be.
template <class Number>
const Vector<Number>& wide(const Vector<Number>& p) {
  return p;
}
Vector<int128> wide(const Vector<std::int64_t>& p) { return {p.x, p.y, p.z}; }

// The square of a radius, from the ways from the first corner to the others.
template <class Result, class Number>
Result square_of(std::size_t size, const std::array<Vector<Number>, 3>& ways, const Number& one) {
  const auto& [b, c, d] = ways;
  if (size == 2) return Result::of(dot(b, b), four_times(one));
  if (size == 3) {
    const auto normal = cross(b, c);
    const Vector<Number> third = minus(c, b);
    return Result::of(dot(b, b) * dot(c, c) * dot(third, third), four_times(dot(normal, normal)));
  }
  const Sphere<Number> sphere(b, c, d);
  const auto center = wide(sphere.center);
  return Result::of(dot(center, center), four_times(sphere.determinant * sphere.determinant));
}

// The ways from the first corner, each coordinate less that of the first, both as `integer` makes them integers.
template <class Number, class Integer>
std::array<Vector<Number>, 3> integer_ways(const Simplex& s, const Integer& integer) {
  std::array<Vector<Number>, 3> ways{};
  const Point3& a = *s.corner[0];
  for (std::size_t k = 1; k < s.size; ++k) {
    const Point3& p = *s.corner[k];
    ways[k - 1] = {integer(p.x) - integer(a.x), integer(p.y) - integer(a.y), integer(p.z) - integer(a.z)};
  }
  return ways;
}

// The grid of all corners of two simplices, which may be one.
DyadicGrid grid_of(const Simplex& p, const Simplex& q) {
  std::array<double, 24> values{};
  std::size_t next = 0;
  for (const Simplex* s : {&p, &q}) {
    for (std::size_t k = 0; k < s->size; ++k) {
      const Point3& at = *s->corner[k];
      for (const double value : {at.x, at.y, at.z}) values[next++] = value;
    }
  }
  return DyadicGrid(values);
}

FixedInteger<1> word_of(const DyadicGrid& grid, double value) {
  return {{static_cast<std::uint64_t>(grid.integer(value))}};
}

WordSquare word_square(const Simplex& s, const DyadicGrid& grid) {
  const auto integer = [&](double value) { return word_of(grid, value); };
  return square_of<WordSquare>(s.size, integer_ways<FixedInteger<1>>(s, integer), FixedInteger<1>{{1}});
}

BigInteger integer_of(const DyadicGrid& grid, double value) {
  const numbers::OddMantissa parts(value);
  if (parts.mantissa == 0) return {};
  const BigInteger magnitude = BigInteger(parts.mantissa) << (parts.exponent - grid.exponent);
  return parts.is_negative ? -magnitude : magnitude;
}

SquaredRadius wide_square(const Simplex& s) {
  const DyadicGrid grid = grid_of(s, s);
  const auto integer = [&](double value) { return integer_of(grid, value); };
  WideSquare found = square_of<WideSquare>(s.size, integer_ways<BigInteger>(s, integer), BigInteger(1));
  return {std::move(found.numerator), std::move(found.denominator), grid.exponent};
}

// The signs of the heights of the center.
std::array<int, 4> exact_heights(const Simplex& s) {
  const DyadicGrid grid = grid_of(s, s);
  std::array<int, 4> signs;
  const auto put = [&](const auto& ways) {
    const auto heights = Sphere(ways[0], ways[1], ways[2]).heights();
    std::transform(heights.begin(), heights.end(), signs.begin(),
                   [](const auto& value) { return value.sign(); });
  };
  if (grid.bits <= word_bits) {
    put(integer_ways<FixedInteger<1>>(s, [&](double value) { return word_of(grid, value); }));
  } else {
    put(integer_ways<BigInteger>(s, [&](double value) { return integer_of(grid, value); }));
  }
  return signs;
}

// The square of a radius in twice as many digits. The formulas are those of its estimate, with exact differences, and
// operations that err by 15 u^2 where those err by u; and of squares errors are twice as large.
alpha::FineRadius refine(const Estimate& found, const Simplex& simplex) {
  std::array<Vector<DoubleDouble>, 3> ways{};
  const Point3& a = *simplex.corner[0];
  for (std::size_t k = 1; k < simplex.size; ++k) {
    const Point3& p = *simplex.corner[k];
    ways[k - 1] = {numbers::two_difference(p.x, a.x), numbers::two_difference(p.y, a.y),
                   numbers::two_difference(p.z, a.z)};
  }
  const FineSquare square = square_of<FineSquare>(simplex.size, ways, DoubleDouble(1.0));
  const DoubleDouble quotient = square.numerator / square.denominator;
  return {quotient, 48 * u * found.error * quotient.head};
}

double settled_radius(const Estimate& found, const Simplex& s) {
  if (found.error < worst_error) {
    const double low = found.radius * (1 - found.error), high = found.radius * (1 + found.error);
    if (rounded_by(open_bits, low) == rounded_by(open_bits, high)) return found.radius;
  }
  if (found.error < worst_refined) {  // the double nearest to the exact radius, where both bounds round to it
    const alpha::FineRadius fine = refine(found, s);
    const DoubleDouble root = sqrt(fine.square);
    const double error =
        fine.error / root.head + 16 * u * u * root.head;  // twice that of the root by the square
    const double low = root.head + (root.tail - error), high = root.head + (root.tail + error);
    if (low == high) return low;
  }
  return alpha::rounded_root(wide_square(s));
}

double squared_distance(const Point3& a, const Point3& b) {
  const Vector<double> way = from_to(a, b);
  return dot(way, way);
}

std::uint8_t sides_cut(const Simplex& simplex, bool are_integers) {
  const auto& corner = simplex.corner;
  std::array<std::array<double, 4>, 4> square;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t l = 0; l < k; ++l)
      square[k][l] = square[l][k] = squared_distance(*corner[k], *corner[l]);
  }
  unsigned result = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t a = (k + 1) % 4, b = (k + 2) % 4, c = (k + 3) % 4;
    const double sum = square[a][b] + square[b][c] + square[c][a];
    const double error = are_integers && sum < exact_limit ? 0 : side_error * sum + side_guard;
    for (const auto& [v, p, q] : {std::array{a, b, c}, std::array{b, c, a}, std::array{c, a, b}}) {
      const double excess = 2 * square[p][q] - sum;
      const bool is_clear = std::abs(excess) >= error && sum < infinity;
      if (is_clear ? excess > 0
                   : is_inside_diametral_sphere(*corner[p], *corner[q], *corner[v], are_integers))
        result |= 1U << side_between[p][q];
    }
  }
  return static_cast<std::uint8_t>(result);
}

}  // namespace

double ranked_radius(const Simplex& simplex, bool are_integers) {
  return settled_radius(estimate(simplex, are_integers), simplex);
}

TetrahedronMeasure measure_tetrahedron(const Simplex& simplex, bool are_integers) {
  const TetrahedronEstimate found = estimate_tetrahedron(simplex, are_integers);
  TetrahedronMeasure result{settled_radius(found.radius, simplex), 0, sides_cut(simplex, are_integers)};
  const std::array<double, 4> heights = found.sphere.heights();
  std::array<int, 4> signs;
  for (std::size_t k = 0; k < 4; ++k) {
    signs[k] = numbers::sign_of(heights[k]);
    if (!(std::abs(heights[k]) > found.doubts[k]) && found.doubts[k] != 0) {
      signs = exact_heights(simplex);
      break;
    }
  }
  for (std::size_t k = 0; k < 4; ++k) result.cut |= static_cast<std::uint8_t>(signs[k] < 0 ? 1 << k : 0);
  return result;
}

// Sums of products of three differences and squares of lengths have at most 64 bits, so all but the square of a center.
std::optional<ExactRadius::ShortSquare> ExactRadius::short_square(const Simplex& s) {
  std::array<Vector<std::int64_t>, 3> ways{};
  for (std::size_t k = 1; k < s.size; ++k) {
    const Vector<double> way = from_to(*s.corner[0], *s.corner[k]);
    if (!(extent(way) < most_short)) return std::nullopt;
    const auto integer = [](double value) { return static_cast<std::int64_t>(value); };
    ways[k - 1] = {integer(way.x), integer(way.y), integer(way.z)};
  }
  return square_of<ShortSquare>(s.size, ways, std::int64_t{1});
}

ExactRadius::ExactRadius(const Simplex& simplex, bool are_integers)
    : simplex_(simplex), are_integers_(are_integers) {
  if (are_integers) square_ = short_square(simplex);
}

int ExactRadius::compare(const Simplex& p) const {
  if (square_) {
    if (const std::optional<ShortSquare> square = short_square(p)) {
      const int128 left = square->numerator * square_->denominator,
                   right = square_->numerator * square->denominator;
      return (left > right) - (left < right);
    }
  }
  const Simplex& q = simplex_;
  const Estimate e = estimate(p, are_integers_), f = estimate(q, are_integers_);
  const double difference = e.radius - f.radius;
  if (std::abs(difference) > 2 * (e.error * e.radius + f.error * f.radius))
    return numbers::sign_of(difference);
  const DyadicGrid grid = grid_of(p, q);
  if (grid.bits <= word_bits) {
    const WordSquare a = word_square(p, grid), b = word_square(q, grid);
    return (a.numerator * b.denominator - b.numerator * a.denominator).sign();
  }
  return alpha::compare(wide_square(p), wide_square(q));
}

alpha::FineRadius refine_radius(const Simplex& simplex) {
  const Estimate found = estimate(simplex, false);
  if (!(found.error < infinity)) return {found.radius, infinity};
  return refine(found, simplex);
}

bool is_inside_diametral_sphere(const Point3& a, const Point3& b, const Point3& v, bool are_integers) {
  const Vector<double> p = from_to(v, a), q = from_to(v, b);
  const double value = dot(p, q), terms = dot(absolute(p), absolute(q));
  if (are_integers && terms < exact_limit) return value < 0;
  if (std::abs(value) > 8 * u * terms + 0x1p-1000 && terms < infinity) return value < 0;
  const Simplex corners{{&v, &a, &b, nullptr}, 3};
  const DyadicGrid grid = grid_of(corners, corners);
  if (grid.bits <= word_bits) {  // differences are below 2^62, and sums of three products below 2^126
    const auto [s, t, none] =
        integer_ways<int128>(corners, [&](double x) { return int128{grid.integer(x)}; });
    return dot(s, t) < 0;
  }
  const auto [s, t, none] = integer_ways<BigInteger>(corners, [&](double x) { return integer_of(grid, x); });
  return dot(s, t).sign() < 0;
}

}  // namespace vorotool::core::tetrahedral_alpha
