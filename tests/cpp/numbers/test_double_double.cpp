#include <cmath>

#include "check.hpp"
#include "core/numbers/double_double.hpp"

using namespace vorotool::core::numbers;
using namespace vorotool::tests;

namespace {

constexpr double u2 = 0x1p-106;  // u^2

int128 drawn(Random& random, int bits) {
  const int128 wide =
      int128{random.whole(INT64_MIN, INT64_MAX)} << 62 | random.whole(0, (std::int64_t{1} << 62) - 1);
  return wide >> (127 - random.whole(2, bits));
}
// Of what arithmetic with integers gives: integers again.
int128 value_of(const DoubleDouble& a) { return static_cast<int128>(a.head) + static_cast<int128>(a.tail); }

bool is_near(const DoubleDouble& a, int128 right, double part) {
  return std::abs(static_cast<double>(value_of(a) - right)) <= part * std::abs(static_cast<double>(right));
}

}  // namespace

TEST(integers_of_106_bits_are_exact) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const int128 value = drawn(random, 105);
    const DoubleDouble a(value);
    CHECK(value_of(a) == value);
    equal(a.head, a.head + a.tail);
    CHECK((a < DoubleDouble(value + 1)) && (DoubleDouble(value + 1) > a) && !(a < a));
  }
}

TEST(errors_are_within_their_bounds) {
  Random random(2);
  for (int i = 0; i < 20000; ++i) {
    const int128 a = drawn(random, 104), b = drawn(random, 104);
    CHECK(is_near(DoubleDouble(a) + DoubleDouble(b), a + b, 3 * u2 + 13 * u2 * 0x1p-53));
    CHECK(is_near(DoubleDouble(a) - DoubleDouble(b), a - b, 3 * u2 + 13 * u2 * 0x1p-53));
    const int128 c = drawn(random, 62), d = drawn(random, 62);
    CHECK(is_near(DoubleDouble(c) * DoubleDouble(d), c * d, 7 * u2));
  }
}

TEST(quotients_and_roots_undo_products) {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    const std::int64_t a = random.whole(1, std::int64_t{1} << 52), b = random.whole(1, std::int64_t{1} << 52);
    const DoubleDouble product = DoubleDouble(static_cast<double>(a)) * DoubleDouble(static_cast<double>(b));
    const DoubleDouble quotient = product / DoubleDouble(static_cast<double>(b));
    CHECK(abs(quotient - DoubleDouble(static_cast<double>(a))).head <= 16 * u2 * static_cast<double>(a));
    const DoubleDouble root = sqrt(DoubleDouble(int128{a} * a));
    CHECK(abs(root - DoubleDouble(static_cast<double>(a))).head <= 8 * u2 * static_cast<double>(a));
    const DoubleDouble irrational = sqrt(DoubleDouble(static_cast<double>(a)));
    const DoubleDouble rest = irrational * irrational - DoubleDouble(static_cast<double>(a));
    CHECK(std::abs(rest.head) <= 24 * u2 * static_cast<double>(a));
  }
  equal(sqrt(DoubleDouble(0.0)).head, 0.0);
  equal(sqrt(DoubleDouble(-1.0)).head, 0.0);
}
