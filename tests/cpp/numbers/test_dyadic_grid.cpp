#include <array>
#include <cmath>
#include <limits>

#include "check.hpp"
#include "core/numbers/dyadic_grid.hpp"
#include "core/numbers/rounded_quotient.hpp"

using namespace vorotool::core::numbers;
using namespace vorotool::tests;

TEST(values_are_integers_on_their_grid) {
  Random random(1);
  for (int i = 0; i < 10000; ++i) {
    std::array<double, 3> values;
    for (double& value : values) {
      value = std::ldexp(static_cast<double>(random.whole(-(1 << 20), 1 << 20)),
                         static_cast<int>(random.whole(-8, 8)));
    }
    const DyadicGrid grid(values);
    std::int64_t all = 0;
    for (const double value : values) {
      const std::int64_t whole = grid.integer(value);
      all |= whole;
      equal(std::ldexp(static_cast<double>(whole), grid.exponent), value);
      CHECK(std::abs(whole) < std::int64_t{1} << grid.bits);
      CHECK(grid.fixed_integer<2>(value).limb == widen(whole).limb);
    }
    CHECK(all == 0 || (all & 1) == 1);  // a coarser one does not hold them
  }
}

TEST(the_whole_range_of_doubles) {
  constexpr double least = std::numeric_limits<double>::denorm_min(),
                   most = std::numeric_limits<double>::max();
  const DyadicGrid grid(std::array{least, most, 0.0});
  equal(grid.exponent, -1074);
  equal(grid.bits, 2098);
  const auto sum = grid.fixed_integer<33>(most) + grid.fixed_integer<33>(-most);
  equal(sum.sign(), 0);
  equal(bit_width(grid.fixed_integer<33>(least)), 1);
  equal(bit_width(grid.fixed_integer<33>(most)), 2098);
  equal(grid.fixed_integer<33>(0.0).sign(), 0);
  equal(DyadicGrid(std::array{0.0, -0.0}).bits, 0);
}
