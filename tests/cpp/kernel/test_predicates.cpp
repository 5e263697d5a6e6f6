#include <array>
#include <cmath>
#include <limits>

#include "check.hpp"
#include "core/kernel/predicates.hpp"
#include "core/numbers/int128.hpp"

using namespace vorotool::core::kernel;
using namespace vorotool::tests;
using vorotool::core::numbers::int128;
using vorotool::core::numbers::undecided;

namespace {

// Points of one kind: small integers, where ties abound, and long ones; doubles of one size; places on a
// line or a circle, rounded, where filters fail; and all magnitudes mixed, the least and the greatest too.
enum class Kind { small, whole, moderate, near_line, near_circle, mixed };
constexpr std::array kinds{Kind::small,     Kind::whole,       Kind::moderate,
                           Kind::near_line, Kind::near_circle, Kind::mixed};

double fraction(Random& random) {
  return std::ldexp(static_cast<double>(random.whole(-(std::int64_t{1} << 53), std::int64_t{1} << 53)), -53);
}

double of_any_size(Random& random) {
  switch (random.whole(0, 6)) {
    case 0:
      return 0;
    case 1:
      return std::numeric_limits<double>::denorm_min() * static_cast<double>(random.whole(-3, 3));
    case 2:
      return std::numeric_limits<double>::max() * (random.whole(0, 1) == 0 ? 1 : -1);
    default:
      return std::ldexp(fraction(random), static_cast<int>(random.whole(-1074, 1024)));
  }
}

Point drawn(Random& random, Kind kind) {
  const auto small = [&] { return static_cast<double>(random.whole(-4, 4)); };
  const double t = fraction(random);
  switch (kind) {
    case Kind::small:
      return {small(), small()};
    case Kind::whole:
      return {std::trunc(t * 0x1p40), std::trunc(fraction(random) * 0x1p40)};
    case Kind::moderate:
      return {fraction(random) * 1000, fraction(random) * 1000};
    case Kind::near_line:
      return {0.1 + t * 3, 0.7 + t * 7};
    case Kind::near_circle:
      return {2 * t / (1 + t * t), (1 - t * t) / (1 + t * t)};
    case Kind::mixed:
      break;
  }
  return {of_any_size(random), of_any_size(random)};
}

// A stage leaves a call open or decides it as all others do.
void agrees(int stage, int right, const Where& where = Where::current()) {
  if (stage != undecided) vorotool::tests::equal(stage, right, where);
}

}  // namespace

TEST(stages_of_orient2d_agree) {
  Random random(1);
  for (const Kind kind : kinds) {
    for (int i = 0; i < 4000; ++i) {
      const Point a = drawn(random, kind), b = drawn(random, kind), c = drawn(random, kind);
      const int sign = orient2d_wide(a, b, c);
      equal(orient2d(a, b, c), sign);
      equal(orient2d_beyond_filter(a, b, c), sign);
      agrees(orient2d_filter(a, b, c), sign);
      agrees(orient2d_integers(a, b, c), sign);
      agrees(orient2d_expansions(a, b, c), sign);
      agrees(side_filter(seen_from(a, b, c)), sign);
      equal(orient2d(b, c, a), sign);
      equal(orient2d(b, a, c), -sign);
    }
  }
}

TEST(stages_of_incircle_agree) {
  Random random(2);
  for (const Kind kind : kinds) {
    for (int i = 0; i < 2000; ++i) {
      const Point a = drawn(random, kind), b = drawn(random, kind), c = drawn(random, kind),
                  d = drawn(random, kind);
      const int sign = incircle_wide(a, b, c, d);
      equal(incircle(a, b, c, d), sign);
      equal(incircle_beyond_filter(a, b, c, d), sign);
      agrees(incircle_filter(a, b, c, d), sign);
      agrees(incircle_integers(a, b, c, d), sign);
      agrees(incircle_expansions(a, b, c, d), sign);
      equal(incircle(b, c, a, d), sign);
      equal(incircle(b, a, c, d), -sign);
      equal(incircle(b, a, d, c), sign);
    }
  }
}

TEST(each_stage_decides_what_it_is_made_for) {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const auto drawn_of = [&](Kind kind) { return drawn(random, kind); };
    const Point a = drawn_of(Kind::small), b = drawn_of(Kind::small), c = drawn_of(Kind::small),
                d = drawn_of(Kind::small);
    CHECK(orient2d_integers(a, b, c) != undecided);
    CHECK(incircle_integers(a, b, c, d) != undecided);
    const Point p = drawn_of(Kind::moderate), q = drawn_of(Kind::moderate), r = drawn_of(Kind::moderate),
                s = drawn_of(Kind::moderate);
    CHECK(orient2d_expansions(p, q, r) != undecided);
    CHECK(incircle_expansions(p, q, r, s) != undecided);
  }
  const Point origin{0, 0}, least{0x1p-1074, 0}, most{0x1p1023, 0x1p1023};
  equal(orient2d_integers(origin, least, most), undecided);
  equal(orient2d_expansions(least, most, {0x1p-1074, 0x1p-1074}), undecided);
  equal(orient2d(origin, least, most), 1);
  equal(orient2d_filter({0, 0}, {1, 1}, {2, 2}), undecided);
}

TEST(orient2d_of_integers) {
  Random random(4);
  for (int i = 0; i < 5000; ++i) {
    const std::int64_t most = std::int64_t{1} << random.whole(1, 52);
    const auto next = [&] { return random.whole(-most, most); };
    const std::int64_t ax = next(), ay = next(), bx = next(), by = next(), cx = next(), cy = next();
    const int128 right = int128{ax - cx} * (by - cy) - int128{ay - cy} * (bx - cx);
    const auto point = [](std::int64_t x, std::int64_t y) {
      return Point{static_cast<double>(x), static_cast<double>(y)};
    };
    equal(orient2d(point(ax, ay), point(bx, by), point(cx, cy)), (right > 0) - (right < 0));
  }
}

// A point moves to its neighbor among the doubles: from a tie to either side.
TEST(neighbors_of_ties_are_none) {
  Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const auto x = static_cast<double>(random.whole(1, 1 << 20)),
               y = static_cast<double>(random.whole(1, 1 << 20));
    const Point a{-x, -y}, b{x, y}, c{3 * x, 3 * y};
    equal(orient2d(a, b, c), 0);
    equal(orient2d(a, b, {c.x, std::nextafter(c.y, HUGE_VAL)}), 1);
    equal(orient2d(a, b, {c.x, std::nextafter(c.y, -HUGE_VAL)}), -1);
    const Point right{y, -x}, left{-y, x};  // all four on one circle around the origin
    equal(incircle(a, right, b, left), 0);
    equal(incircle(a, right, b, {left.x, std::nextafter(left.y, HUGE_VAL)}), -1);
    equal(incircle(a, right, b, {left.x, std::nextafter(left.y, -HUGE_VAL)}), 1);
  }
}
