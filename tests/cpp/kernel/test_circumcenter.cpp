#include <array>
#include <cmath>
#include <utility>

#include "check.hpp"
#include "core/kernel/circumcenter.hpp"
#include "core/kernel/predicates.hpp"

using namespace vorotool::core::kernel;
using namespace vorotool::tests;
using vorotool::core::numbers::Rounded;
using vorotool::core::numbers::undecided;

namespace {

// On integers below 2^bits, times a power of two; ties where there are few.
Point drawn(Random& random, int bits, int exponent) {
  const std::int64_t most = std::int64_t{1} << bits;
  const auto next = [&] { return std::ldexp(static_cast<double>(random.whole(-most, most)), exponent); };
  return {next(), next()};
}

void agrees(const Rounded& estimate, const Rounded& exact) {
  equal(estimate.value, exact.value);
  if (estimate.error_sign != undecided) equal(estimate.error_sign, exact.error_sign);
}

constexpr double infinity = HUGE_VAL;

}  // namespace

TEST(estimates_of_centers_are_the_exact_ones) {
  Random random(1);
  for (int i = 0; i < 6000; ++i) {
    const int bits = std::array{2, 20, 53}[static_cast<std::size_t>(i % 3)];
    const int exponent = static_cast<int>(random.whole(-60, 60));
    const Point a = drawn(random, bits, exponent), b = drawn(random, bits, exponent),
                c = drawn(random, bits, exponent);
    if (orient2d(a, b, c) == 0) continue;
    const RoundedPoint estimate = circumcenter(a, b, c), exact = circumcenter_exactly(a, b, c);
    agrees(estimate.x, exact.x);
    agrees(estimate.y, exact.y);
    const RoundedPoint turned = circumcenter(b, c, a);
    equal(turned.x.value, exact.x.value);
    equal(turned.y.value, exact.y.value);
  }
}

// Fibonacci's numbers go on in nearly one direction: with a first point that has bits far below, what is left
// of the area has lost most of 106 bits, and estimates have to see that.
TEST(centers_of_slivers_are_exact) {
  Random random(5);
  for (int i = 0; i < 4000; ++i) {
    std::int64_t before = 1, last = 1;
    for (std::int64_t n = random.whole(50, 74); n > 0; --n) before = std::exchange(last, before + last);
    const Point a = drawn(random, 53, -78),
                c{static_cast<double>(before), static_cast<double>(last - before)},
                b{static_cast<double>(last), static_cast<double>(before)};
    const RoundedPoint estimate = circumcenter(a, b, c), exact = circumcenter_exactly(a, b, c);
    agrees(estimate.x, exact.x);
    agrees(estimate.y, exact.y);
  }
}

TEST(centers_that_are_known) {
  const RoundedPoint center = circumcenter_exactly({0, 0}, {4, 0}, {0, 2});
  equal(center.x.value, 2.0);
  equal(center.y.value, 1.0);
  equal(center.x.error_sign, 0);
  const RoundedPoint sixths = circumcenter({0, 0}, {1, 1}, {2, -1});
  equal(sixths.x.value, 7.0 / 6);
  equal(sixths.y.value, -1.0 / 6);
  equal(sixths.y.error_sign, -1);  // beyond the bits of a double, 1/6 goes on with 0101
  const RoundedPoint far = circumcenter({0, 0}, {0x1p-1000, 0x1p-1074}, {0x1p-999, 0});
  equal(far.x.value, 0x1p-1000);
  CHECK(far.y.value < -0x1p-930);
}

// Centers of triples of cocircular points are the same doubles.
TEST(coincident_centers_are_one) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Point at = drawn(random, 30, 0);
    const auto x = static_cast<double>(random.whole(1, 1 << 30)),
               y = static_cast<double>(random.whole(1, 1 << 30));
    if (x == y) continue;
    const auto around = [&](double dx, double dy) { return Point{at.x + dx, at.y + dy}; };
    const std::array circle{around(x, y),  around(-y, x), around(-x, -y),
                            around(y, -x), around(y, x),  around(-x, y)};
    for (std::size_t j = 0; j < circle.size(); ++j) {
      const RoundedPoint center = circumcenter(circle[j], circle[(j + 1) % 6], circle[(j + 2) % 6]);
      equal(center.x.value, at.x);
      equal(center.y.value, at.y);
    }
  }
}

// A rounded place on a bisector has the exact one between its two neighbors.
TEST(bisectors_are_rounded_to_the_nearest) {
  Random random(3);
  for (int i = 0; i < 4000; ++i) {
    const int bits = i % 2 == 0 ? 4 : 40;
    const int exponent = static_cast<int>(random.whole(-300, 300));
    const Point a = drawn(random, bits, exponent), b = drawn(random, bits, exponent);
    if (a.y == b.y) continue;
    const double x = drawn(random, bits, exponent).x, y = bisector_at(x, a, b);
    const int above = b.y > a.y ? 1 : -1;  // b is the nearer one high up
    equal(compare_distances({x, std::nextafter(y, infinity)}, a, b), above);
    equal(compare_distances({x, std::nextafter(y, -infinity)}, a, b), -above);
    equal(bisector_at(x, b, a), y);
  }
}

TEST(distances_compare_as_their_integers_do) {
  Random random(4);
  for (int i = 0; i < 5000; ++i) {
    const int bits = static_cast<int>(random.whole(1, 29));
    const Point q = drawn(random, bits, 0), a = drawn(random, bits, 0), b = drawn(random, bits, 0);
    const auto square = [&](const Point& p) {
      const auto dx = static_cast<std::int64_t>(q.x - p.x), dy = static_cast<std::int64_t>(q.y - p.y);
      return dx * dx + dy * dy;
    };
    const std::int64_t to_a = square(a), to_b = square(b);
    equal(compare_distances(q, a, b), (to_a > to_b) - (to_a < to_b));
    equal(compare_distances(q, {2 * q.x - a.x, 2 * q.y - a.y}, a), 0);
  }
  equal(compare_distances({0, 0}, {0x1p-1074, 0}, {0, 0}), 1);
  equal(compare_distances({0x1p1023, 0}, {-0x1p1023, 0}, {-0x1p1023, 0x1p-1074}), -1);
}
