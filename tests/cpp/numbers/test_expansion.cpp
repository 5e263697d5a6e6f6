#include <cmath>

#include "check.hpp"
#include "core/numbers/expansion.hpp"
#include "core/numbers/int128.hpp"

using namespace vorotool::core::numbers;
using namespace vorotool::tests;

namespace {

int128 whole(double value) { return static_cast<int128>(value); }

// An integer of at most 53 bits times a power of two.
double drawn_double(Random& random, int most_bits) {
  const auto mantissa = static_cast<double>(random.whole(-(std::int64_t{1} << 53), std::int64_t{1} << 53));
  return std::trunc(std::ldexp(mantissa, static_cast<int>(random.whole(-53, most_bits - 53))));
}

template <int capacity>
int128 value_of(const Expansion<capacity>& e) {
  int128 sum = 0;
  for (const double term : e.terms()) sum += whole(term);
  return sum;
}

}  // namespace

TEST(sums_and_products_keep_what_is_rounded) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const double a = drawn_double(random, 120), b = drawn_double(random, 120);
    const TwoTerms sum = two_sum(a, b), difference = two_difference(a, b);
    equal(sum.head, a + b);
    CHECK(whole(sum.head) + whole(sum.tail) == whole(a) + whole(b));
    CHECK(whole(difference.head) + whole(difference.tail) == whole(a) - whole(b));
    const double c = drawn_double(random, 62), d = drawn_double(random, 62);
    const TwoTerms product = two_product(c, d, split(d));
    equal(product.head, c * d);
    CHECK(whole(product.head) + whole(product.tail) == whole(c) * whole(d));
  }
}

TEST(halves_have_26_bits) {
  Random random(2);
  for (int i = 0; i < 20000; ++i) {
    const double a = drawn_double(random, 900);
    const TwoTerms halves = split(a);
    equal(halves.head + halves.tail, a);
    for (const double half : {halves.head, halves.tail}) {
      int exponent = 0;
      const double mantissa = std::ldexp(std::frexp(half, &exponent), 26);
      equal(mantissa, std::trunc(mantissa));
    }
  }
}

TEST(expansions_are_the_integers_that_they_stand_for) {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    const double a = drawn_double(random, 50), b = drawn_double(random, 50), c = drawn_double(random, 24);
    const Expansion<2> sum(two_sum(a, b)), difference(two_difference(a, b));
    CHECK(value_of(sum * difference) == (whole(a) + whole(b)) * (whole(a) - whole(b)));
    const auto all = (sum * c + difference) - -sum;
    const int128 right = (whole(a) + whole(b)) * (whole(c) + 1) + whole(a) - whole(b);
    CHECK(value_of(all) == right);
    if (all.sign() != undecided) equal(all.sign(), (right > 0) - (right < 0));
  }
}

TEST(signs_of_what_cancels) {
  const double big = 0x1p53, third = 1.0 / 3;
  const Expansion<2> one(two_sum(1, 0)), large(two_sum(big, 1)), small(two_sum(big, -1));
  const Expansion<2> x(two_sum(third, big));
  equal((x * x - x * x).sign(), 0);
  equal((large * small - Expansion<2>(two_sum(big, 0)) * big).sign(), -1);  // -1
  equal((large * small + one - Expansion<2>(two_sum(big, 0)) * big).sign(), 0);
  equal((large - small - one).sign(), 1);
}

TEST(a_last_term_that_does_not_outweigh_the_others_is_no_sign) {
  Expansion<3> e;
  equal(e.sign(), 0);
  for (const double term : {1.0, 0.0, -1.0}) e.append(term);
  equal(e.size, 2);
  equal(e.sign(), undecided);
}
