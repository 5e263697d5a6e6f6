#include <algorithm>
#include <cmath>
#include <utility>

#include "check.hpp"
#include "core/numbers/big_integer.hpp"

using namespace vorotool::core::numbers;
using namespace vorotool::tests;

namespace {

int128 wide(Random& random) {
  return int128{random.whole(INT64_MIN, INT64_MAX)} << 62 >> random.whole(0, 120);
}

// Of some limbs, up to and beyond those that lie in the object.
BigInteger drawn(Random& random) {
  BigInteger value(wide(random));
  for (std::int64_t more = random.whole(0, 25); more > 0; --more) {
    value = (value << static_cast<int>(random.whole(0, 100))) + BigInteger(wide(random));
  }
  return value;
}

int sign(int128 value) { return (value > 0) - (value < 0); }

}  // namespace

TEST(short_ones_are_integers_of_128_bits) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const int128 a = wide(random) >> 2, b = i % 3 == 0 ? a + random.whole(-1, 1) : wide(random) >> 2;
    CHECK(BigInteger(a) + BigInteger(b) == BigInteger(a + b));
    CHECK(BigInteger(a) - BigInteger(b) == BigInteger(a - b));
    equal(compare(BigInteger(a), BigInteger(b)), sign(a - b));
    const auto c = static_cast<std::int64_t>(a >> 64), d = static_cast<std::int64_t>(b >> 64);
    CHECK(BigInteger(c) * BigInteger(d) == BigInteger(int128{c} * d));
    CHECK((BigInteger(c) << 60) == BigInteger(int128{c} << 60));
  }
}

TEST(long_ones_obey_the_rules_of_arithmetic) {
  Random random(2);
  for (int i = 0; i < 3000; ++i) {
    const BigInteger a = drawn(random), b = drawn(random), c = drawn(random);
    CHECK((a + b) * (a - b) == a * a - b * b);
    CHECK(a * (b + c) == a * b + a * c);
    equal((a * b).sign(), a.sign() * b.sign());
    equal(compare(a, b), (a - b).sign());
    equal(compare(a, b), -compare(b, a));
    const int bits = static_cast<int>(random.whole(0, 1500));
    CHECK((a << bits) - a == a * ((BigInteger(1) << bits) - BigInteger(1)));
    if (a.sign() != 0) equal((a << bits).bits(), a.bits() + static_cast<std::size_t>(bits));
    equal((a - a).sign(), 0);
    equal((a - a).bits(), 0U);
  }
}

TEST(copies_stay_when_the_original_goes) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    BigInteger a = drawn(random), b = drawn(random);
    const BigInteger sum = a + b, copy = a;
    a += b;
    CHECK(a == sum && a - b == copy);
    const BigInteger& same = a;
    a = same;
    CHECK(a == sum);
    BigInteger taken = std::move(a);
    a = copy;
    CHECK(taken == sum && a == copy);
    a -= same;
    equal(a.sign(), 0);
  }
}

TEST(roots_of_squares_only) {
  Random random(4);
  for (int i = 0; i < 5000; ++i) {
    BigInteger root(wide(random) >> 1);
    if (root.sign() < 0) root.negate();
    if (root.sign() == 0) continue;
    const auto found = integer_root(root * root);
    CHECK(found && *found == root);
    CHECK(!integer_root(root * root + BigInteger(1)));
    if (root.bits() > 1) CHECK(!integer_root(root * root - BigInteger(1)));
    CHECK(!integer_root(-(root * root)));
  }
  CHECK(!integer_root(BigInteger(0)));
}

TEST(rounded_and_leading_bits) {
  Random random(5);
  for (int i = 0; i < 5000; ++i) {
    const std::int64_t a = random.whole(-(std::int64_t{1} << 53), std::int64_t{1} << 53);
    const int bits = static_cast<int>(random.whole(0, 900));
    const BigInteger shifted = BigInteger(a) << bits;
    equal(shifted.rounded(), std::ldexp(static_cast<double>(a), bits));
    if (a == 0) continue;
    equal(shifted.leading_bits(), static_cast<std::uint64_t>(a < 0 ? -a : a) << (64 - BigInteger(a).bits()));
    const BigInteger more = shifted + (BigInteger(1) << std::max(0, bits - 60));
    CHECK(std::abs(more.rounded() - shifted.rounded()) <= std::ldexp(1.0, bits));
  }
}
