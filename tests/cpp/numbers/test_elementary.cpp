#include <cmath>
#include <limits>
#include <numbers>

#include "check.hpp"
#include "core/numbers/elementary.hpp"

using namespace vorotool::tests;
using vorotool::core::numbers::angle_of;
using vorotool::core::numbers::hypotenuse;

TEST(lengths_of_pythagorean_triples_are_exact) {
  Random random(1);
  for (int i = 0; i < 10000; ++i) {
    const std::int64_t m = random.whole(2, 1 << 25), n = random.whole(1, m - 1);
    const int shift = static_cast<int>(random.whole(-1000, 900));
    const double x = std::ldexp(static_cast<double>(m * m - n * n), shift),
                 y = std::ldexp(static_cast<double>(2 * m * n), shift),
                 z = std::ldexp(static_cast<double>(m * m + n * n), shift);
    equal(hypotenuse(x, -y), z);
    equal(hypotenuse(y, x), z);
  }
}

TEST(lengths_at_the_ends_of_the_range) {
  constexpr double infinity = std::numeric_limits<double>::infinity(),
                   nan = std::numeric_limits<double>::quiet_NaN();
  equal(hypotenuse(0, -0.0), 0.0);
  equal(hypotenuse(3 * 0x1p1021, 4 * 0x1p1021), 5 * 0x1p1021);
  equal(hypotenuse(3 * 0x1p1022, 3 * 0x1p1022), infinity);
  equal(hypotenuse(3 * 0x1p-1074, 4 * 0x1p-1074), 5 * 0x1p-1074);
  equal(hypotenuse(nan, infinity), infinity);
  CHECK(std::isnan(hypotenuse(nan, 1)));
}

TEST(angles_of_known_directions) {
  equal(angle_of(1, 0), 0.0);
  equal(angle_of(0, 0), 0.0);
  equal(angle_of(0, 3), std::numbers::pi / 2);
  equal(angle_of(-2, 0), std::numbers::pi);
  CHECK(std::abs(angle_of(1, 1) - std::numbers::pi / 4) < 0x1p-51);
  CHECK(std::abs(angle_of(-1, std::sqrt(3.0)) - 2 * std::numbers::pi / 3) < 0x1p-50);
}
