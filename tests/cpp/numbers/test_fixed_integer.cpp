#include "check.hpp"
#include "core/numbers/fixed_integer.hpp"
#include "core/numbers/rounded_quotient.hpp"

using namespace vorotool::core::numbers;
using namespace vorotool::tests;

namespace {

template <std::size_t limbs>
FixedInteger<limbs> drawn(Random& random) {
  FixedInteger<limbs> value;
  const bool has_runs = random.whole(0, 1) == 1;  // where carries go far
  for (std::uint64_t& limb : value.limb) {
    limb = static_cast<std::uint64_t>(has_runs ? -random.whole(0, 1) : random.whole(INT64_MIN, INT64_MAX));
  }
  value.limb[limbs - 1] = static_cast<std::uint64_t>(static_cast<std::int64_t>(value.limb[limbs - 1]) >> 3);
  return value;
}

int sign_of(int128 value) { return (value > 0) - (value < 0); }

}  // namespace

TEST(two_limbs_are_integers_of_128_bits) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const std::int64_t a = random.whole(INT64_MIN, INT64_MAX), b = random.whole(-3, 3) + (i % 2 == 0 ? a : 0);
    const FixedInteger<1> one{{static_cast<std::uint64_t>(a)}}, other{{static_cast<std::uint64_t>(b)}};
    CHECK((one * other).limb == widen(int128{a} * b).limb);
    CHECK((widen(a) + widen(b)).limb == widen(int128{a} + b).limb);
    CHECK((widen(a) - widen(b)).limb == widen(int128{a} - b).limb);
    equal((widen(a) - widen(b)).sign(), sign_of(int128{a} - b));
    CHECK(resized<2>(one).limb == widen(a).limb);
  }
}

TEST(products_of_sums_are_sums_of_products) {
  Random random(2);
  for (int i = 0; i < 5000; ++i) {
    const auto a = drawn<4>(random), b = drawn<4>(random), c = drawn<4>(random);
    CHECK(((a + b) * (a - b)).limb == (a * a - b * b).limb);
    CHECK((a * (b + c)).limb == (a * b + a * c).limb);
    const auto ab = a * b, ba = b * a;
    CHECK(ab.limb == ba.limb);
    equal(ab.sign(), a.sign() * b.sign());
  }
}

TEST(shifts_and_widths_go_together) {
  Random random(3);
  for (int i = 0; i < 5000; ++i) {
    auto a = resized<8>(drawn<3>(random));
    if (a.is_negative()) a = FixedInteger<8>{} - a;
    const int bits = static_cast<int>(random.whole(0, 300));
    const auto shifted = shifted_left(a, bits);
    equal(bit_width(shifted), a.sign() == 0 ? 0 : bit_width(a) + bits);
    FixedInteger<8> doubled = a;
    for (int k = 0; k < bits; ++k) doubled = doubled + doubled;
    CHECK(doubled.limb == shifted.limb);
  }
}
