#include <cmath>
#include <limits>

#include "check.hpp"
#include "core/numbers/expansion.hpp"
#include "core/numbers/rounded_quotient.hpp"

using namespace vorotool::core::numbers;
using namespace vorotool::tests;

namespace {

FixedInteger<4> fixed(int128 value) { return resized<4>(widen(value)); }
Rounded quotient(int128 a, int128 b, int exponent = 0) {
  return rounded_quotient(fixed(a), fixed(b), exponent);
}

}  // namespace

// Division of doubles is correctly rounded.
TEST(quotients_of_doubles_are_those_of_the_processor) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const std::int64_t most = std::int64_t{1} << random.whole(1, 53);
    const std::int64_t a = random.whole(-most, most), b = random.whole(1, most) * (i % 2 == 0 ? 1 : -1);
    const Rounded found = quotient(a, b);
    const double x = static_cast<double>(a), y = static_cast<double>(b);
    equal(found.value, x / y);
    const TwoTerms product = two_product(x / y, y, split(y));
    equal(found.error_sign, sign_of((x - product.head) - product.tail) * sign_of(y));
  }
}

TEST(half_way_goes_to_the_even_neighbor) {
  const int128 big = int128{1} << 54;
  equal(quotient(big + 2, 1).value, 0x1p54);
  equal(quotient(big + 2, 1).error_sign, 1);
  equal(quotient(big + 6, 1).value, 0x1p54 + 8);
  equal(quotient(big + 6, 1).error_sign, -1);
  equal(quotient(4 * big + 9, 4).value, 0x1p54 + 4);  // a little more than half way
  equal(quotient(-big - 2, 1).value, -0x1p54);
  equal(quotient(-big - 2, 1).error_sign, -1);
}

TEST(subnormal_and_huge_quotients) {
  constexpr double least = std::numeric_limits<double>::denorm_min();
  equal(quotient(1, 1, -1074).value, least);
  equal(quotient(3, 2, -1074).value, 2 * least);  // half way, to even
  equal(quotient(5, 4, -1074).value, least);
  equal(quotient(5, 4, -1074).error_sign, 1);
  equal(quotient(1, 2, -1074).value, 0.0);
  equal(quotient(1, 1, -1200).value, 0.0);
  equal(quotient(1, 1, -1200).error_sign, 1);
  equal(quotient(-1, 3, 2000).value, -std::numeric_limits<double>::infinity());
  equal(quotient(0, 3, 2000).value, 0.0);
  equal(quotient(0, 3, 2000).error_sign, 0);
}

TEST(a_rounded_number_compares_with_every_double) {
  const Rounded third = quotient(1, 3);
  equal(third.compare(1.0 / 3), third.error_sign);
  equal(third.compare(std::nextafter(1.0 / 3, 1)), -1);
  equal(third.compare(std::nextafter(1.0 / 3, 0)), 1);
  equal(quotient(1, 4).compare(0.25), 0);
}
