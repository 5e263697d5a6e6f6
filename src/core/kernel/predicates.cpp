#include "core/kernel/predicates.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/numbers/dyadic_grid.hpp"
#include "core/numbers/expansion.hpp"
#include "core/numbers/fixed_integer.hpp"
#include "core/numbers/int128.hpp"

namespace vorotool::core::kernel {

using numbers::DyadicGrid;
using numbers::Expansion;
using numbers::FixedInteger;
using numbers::int128;
using numbers::undecided;

namespace {

// The coordinates of a call and the lattices that hold them. In orient2d x and y have lattices of their own:
// both steps are factors of the determinant.
struct OrientationCall {
  OrientationCall(const Point& a, const Point& b, const Point& c)
      : x{a.x, b.x, c.x}, y{a.y, b.y, c.y}, x_lattice(x), y_lattice(y) {}
  int bits() const { return std::max(x_lattice.bits, y_lattice.bits); }

  std::array<double, 3> x, y;
  DyadicGrid x_lattice, y_lattice;
};

struct CircleCall {
  CircleCall(const Point& a, const Point& b, const Point& c, const Point& d)
      : x{a.x, b.x, c.x, d.x},
        y{a.y, b.y, c.y, d.y},
        lattice(std::array{a.x, b.x, c.x, d.x, a.y, b.y, c.y, d.y}) {}
  int bits() const { return lattice.bits; }

  std::array<double, 4> x, y;
  DyadicGrid lattice;
};

// Integers that fit a machine word.

// Coordinates of 61 bits have differences below 2^62, their products are below 2^124, sums of two such below
// 2^125. In incircle lifts and minors are such sums; their products are below 2^250 and the determinant, a
// sum of three, below 2^252.
constexpr int integer_bits = 61;
// Coordinates of 29 bits: lifts and minors are below 2^61, products 2^122, the determinant 2^124.
constexpr int short_bits = 29;

int sign_of(int128 value) { return (value > 0) - (value < 0); }

int integer_sign(const OrientationCall& call) {
  auto x = [&](int i) { return call.x_lattice.integer(call.x[i]) - call.x_lattice.integer(call.x[2]); };
  auto y = [&](int i) { return call.y_lattice.integer(call.y[i]) - call.y_lattice.integer(call.y[2]); };
  return sign_of(int128{x(0)} * y(1) - int128{y(0)} * x(1));
}

using Differences = std::array<std::int64_t, 3>;

int short_sign(const Differences& x, const Differences& y) {
  auto lift = [&](int i) { return x[i] * x[i] + y[i] * y[i]; };
  auto minor = [&](int i, int j) { return x[i] * y[j] - x[j] * y[i]; };
  return sign_of(int128{lift(0)} * minor(1, 2) + int128{lift(1)} * minor(2, 0) +
                 int128{lift(2)} * minor(0, 1));
}

int long_sign(const Differences& x, const Differences& y) {
  auto lift = [&](int i) { return numbers::widen(int128{x[i]} * x[i] + int128{y[i]} * y[i]); };
  auto minor = [&](int i, int j) { return numbers::widen(int128{x[i]} * y[j] - int128{x[j]} * y[i]); };
  return (lift(0) * minor(1, 2) + lift(1) * minor(2, 0) + lift(2) * minor(0, 1)).sign();
}

int integer_sign(const CircleCall& call) {
  const std::int64_t last_x = call.lattice.integer(call.x[3]), last_y = call.lattice.integer(call.y[3]);
  Differences x, y;
  for (std::size_t i = 0; i < 3; ++i) {
    x[i] = call.lattice.integer(call.x[i]) - last_x;
    y[i] = call.lattice.integer(call.y[i]) - last_y;
  }
  return call.bits() <= short_bits ? short_sign(x, y) : long_sign(x, y);
}

// Integers of fixed width.

// Coordinates of 64 limbs - 3 bits have differences below 2^(64 limbs - 2). Their products are below
// 2^(128 limbs - 4), lifts and minors below 2^(128 limbs - 3), products of these below 2^(256 limbs - 6), and
// sums of three such leave room for the sign.
constexpr int spare_bits_of_predicates = 3;

// The first values less the last.
template <std::size_t limbs, std::size_t n>
std::array<FixedInteger<limbs>, n - 1> wide_differences(const DyadicGrid& lattice,
                                                        const std::array<double, n>& values) {
  const FixedInteger<limbs> last = lattice.fixed_integer<limbs>(values[n - 1]);
  std::array<FixedInteger<limbs>, n - 1> result;
  for (std::size_t i = 0; i + 1 < n; ++i) result[i] = lattice.fixed_integer<limbs>(values[i]) - last;
  return result;
}

template <std::size_t limbs>
int sign_in_limbs(const OrientationCall& call) {
  const auto x = wide_differences<limbs>(call.x_lattice, call.x);
  const auto y = wide_differences<limbs>(call.y_lattice, call.y);
  return (x[0] * y[1] - y[0] * x[1]).sign();
}

template <std::size_t limbs>
int sign_in_limbs(const CircleCall& call) {
  const auto x = wide_differences<limbs>(call.lattice, call.x);
  const auto y = wide_differences<limbs>(call.lattice, call.y);
  auto lift = [&](int i) { return x[i] * x[i] + y[i] * y[i]; };
  auto minor = [&](int i, int j) { return x[i] * y[j] - x[j] * y[i]; };
  return (lift(0) * minor(1, 2) + lift(1) * minor(2, 0) + lift(2) * minor(0, 1)).sign();
}

template <class Call>
int wide_sign(const Call& call) {
  const int bits = call.bits() + spare_bits_of_predicates;
  if (bits <= 2 * 64) return sign_in_limbs<2>(call);
  if (bits <= 4 * 64) return sign_in_limbs<4>(call);
  if (bits <= 8 * 64) return sign_in_limbs<8>(call);
  if (bits <= 16 * 64) return sign_in_limbs<16>(call);
  static_assert(2098 + spare_bits_of_predicates <= 33 * 64);
  return sign_in_limbs<33>(call);
}

// Expansions.

// Where no operation of the expansions overflows or underflows: coordinates are zero or of magnitudes in
// [least, 2^above), by which they are multiples of least 2^-52, and so are their differences, which are at
// most 2^(above + 1) in magnitude.
struct Range {
  double least;
  int above;
};

// orient2d multiplies an x by a y: terms are multiples of 2^(2 (-484 - 52)) = 2^-1072, and their sums are at
// most 2^(2 501 + 1).
constexpr Range orient2d_range{0x1p-484, 500};
// incircle multiplies four differences: terms are multiples of 2^(4 (-215 - 52)) = 2^-1068, and their sums
// are at most 12 * 2^(4 251) < 2^1008.
constexpr Range incircle_range{0x1p-215, 250};

// Brings the values into the range by an exact power of two, if there is one: then the sign of a homogeneous
// determinant stays. The largest goes to the top; a value that would lose bits by that is below the range.
template <std::size_t n>
bool bring_into(const Range& range, std::array<double, n>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  if (largest == 0) return true;
  const int shift = range.above - 1 - std::ilogb(largest);
  for (double& value : values) {
    if (value == 0) continue;
    value = std::ldexp(value, shift);
    if (std::abs(value) < range.least) return false;
  }
  return true;
}

// The first values less the last, exactly: a difference of two doubles is a sum of two.
template <std::size_t n>
std::array<Expansion<2>, n - 1> exact_differences(const std::array<double, n>& values) {
  std::array<Expansion<2>, n - 1> result;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    result[i] = Expansion<2>(numbers::two_difference(values[i], values[n - 1]));
  }
  return result;
}

int expansion_sign(const OrientationCall& call) {
  std::array<double, 3> xs = call.x, ys = call.y;
  if (!bring_into(orient2d_range, xs) || !bring_into(orient2d_range, ys)) return undecided;
  const auto x = exact_differences(xs), y = exact_differences(ys);
  return (x[0] * y[1] - y[0] * x[1]).sign();
}

int expansion_sign(const CircleCall& call) {
  std::array<double, 8> both;  // scaled by one power of two
  std::copy(call.y.begin(), call.y.end(), std::copy(call.x.begin(), call.x.end(), both.begin()));
  if (!bring_into(incircle_range, both)) return undecided;
  const auto x = exact_differences(std::array{both[0], both[1], both[2], both[3]});
  const auto y = exact_differences(std::array{both[4], both[5], both[6], both[7]});
  auto lift = [&](int i) { return x[i] * x[i] + y[i] * y[i]; };
  auto minor = [&](int i, int j) { return x[i] * y[j] - x[j] * y[i]; };
  return (lift(0) * minor(1, 2) + lift(1) * minor(2, 0) + lift(2) * minor(0, 1)).sign();
}

// The order of the levels.

// Fixed integers of up to four limbs are at least as fast as expansions; these come in where more limbs would
// be needed, and integers again where the range of exponents is too wide for expansions.
constexpr int few_limbs = 4;

template <class Call>
int sign_beyond_filter(const Call& call) {
  if (call.bits() <= integer_bits) return integer_sign(call);
  if (call.bits() + spare_bits_of_predicates <= few_limbs * 64) return wide_sign(call);
  const int sign = expansion_sign(call);
  return sign != undecided ? sign : wide_sign(call);
}

template <class Call>
int sign_by_integers(const Call& call) {
  return call.bits() <= integer_bits ? integer_sign(call) : undecided;
}

}  // namespace

int orient2d_beyond_filter(const Point& a, const Point& b, const Point& c) {
  return sign_beyond_filter(OrientationCall(a, b, c));
}

int incircle_beyond_filter(const Point& a, const Point& b, const Point& c, const Point& d) {
  return sign_beyond_filter(CircleCall(a, b, c, d));
}

int orient2d_integers(const Point& a, const Point& b, const Point& c) {
  return sign_by_integers(OrientationCall(a, b, c));
}

int incircle_integers(const Point& a, const Point& b, const Point& c, const Point& d) {
  return sign_by_integers(CircleCall(a, b, c, d));
}

int orient2d_expansions(const Point& a, const Point& b, const Point& c) {
  return expansion_sign(OrientationCall(a, b, c));
}

int incircle_expansions(const Point& a, const Point& b, const Point& c, const Point& d) {
  return expansion_sign(CircleCall(a, b, c, d));
}

int orient2d_wide(const Point& a, const Point& b, const Point& c) {
  return wide_sign(OrientationCall(a, b, c));
}

int incircle_wide(const Point& a, const Point& b, const Point& c, const Point& d) {
  return wide_sign(CircleCall(a, b, c, d));
}

}  // namespace vorotool::core::kernel
