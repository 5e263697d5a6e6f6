#include <cmath>

#include "check.hpp"
#include "core/numbers/sqrt_tower.hpp"

using namespace vorotool::core::numbers;
using namespace vorotool::tests;

TEST(roots_of_integers_multiply) {
  SqrtTower tower;
  const RootNumber two = tower.adjoin_root(2), three = tower.adjoin_root(3), six = tower.adjoin_root(6);
  equal((two * two - RootNumber(2)).sign(), 0);
  equal((two * three - six).sign(), 0);
  equal((two * three * six - RootNumber(6)).sign(), 0);
  equal((two - three).sign(), -1);
  equal((three + two - RootNumber(3)).sign(), 1);
  equal(RootNumber(0).sign(), 0);
}

TEST(whole_and_known_roots_add_no_level) {
  SqrtTower tower;
  equal((tower.adjoin_root(49) - RootNumber(7)).sign(), 0);
  equal(tower.depth(), 0U);
  const RootNumber two = tower.adjoin_root(2);
  equal(tower.depth(), 1U);
  equal((tower.adjoin_root(2) - two).sign(), 0);
  equal(tower.depth(), 1U);
  equal((tower.adjoin_root(8) - two - two).sign(), 0);  // a level of its own that it does not need
}

TEST(nested_roots_that_can_be_written_without) {
  SqrtTower tower;
  const RootNumber two = tower.adjoin_root(2), three = tower.adjoin_root(3);
  // sqrt(5 + 2 sqrt 6) = sqrt 2 + sqrt 3
  const RootNumber nested = tower.adjoin_root(RootNumber(5) + RootNumber(2) * two * three);
  equal((nested - two - three).sign(), 0);
  equal((nested * nested - RootNumber(5) - RootNumber(2) * two * three).sign(), 0);
  equal((nested - two - three + RootNumber(1)).sign(), 1);
}

// p^2 - 2 q^2 = +-1 in turn: p - q sqrt 2 is soon far below a double's roundings.
TEST(pells_numbers_tell_signs_apart) {
  SqrtTower tower;
  const RootNumber root = tower.adjoin_root(2);
  BigInteger p(1), q(1);
  int sign = -1;
  for (int i = 0; i < 300; ++i) {
    equal((RootNumber(p) - RootNumber(q) * root).sign(), sign);
    const BigInteger next = p + q + q;
    q += p;
    p = next;
    sign = -sign;
  }
}

TEST(roots_are_concave) {
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const std::int64_t n = random.whole(2, std::int64_t{1} << 60);
    SqrtTower tower;
    const RootNumber below = tower.adjoin_root(n - 1), at = tower.adjoin_root(n),
                     above = tower.adjoin_root(n + 1);
    equal((below + above - at - at).sign(), -1);
    equal((above * above - at * at - RootNumber(1)).sign(), 0);
  }
}

TEST(magnitudes_where_nothing_is_left_of_doubles) {
  SqrtTower tower;
  const RootNumber n = tower.adjoin_root((int128{1} << 80) + 1), m = int128{1} << 40;
  // sqrt(m^2 + 1) - m = 1 / (sqrt(m^2 + 1) + m), about 1 / (2 m)
  const double found = magnitude(n - m).rounded();
  CHECK(std::abs(found * 0x1p41 - 1) < 0x1p-50);
  const RootMagnitude two = magnitude(RootNumber(2)), eight = magnitude(RootNumber(-8));
  equal((two * eight).rounded(), 16.0);
  equal((eight / two).rounded(), 4.0);
  equal((eight + two).rounded(), 10.0);
  equal(square_root(two * eight).rounded(), 4.0);
  CHECK(std::abs(square_root(two).rounded() / std::sqrt(2.0) - 1) <= 0x1p-52);
}

TEST(numbers_of_one_tower_in_another) {
  SqrtTower first, second;
  const RootNumber three = first.adjoin_root(3), nested = first.adjoin_root(three + RootNumber(1));
  const RootNumber two = second.adjoin_root(2);
  const std::vector<RootNumber> roots = second.adjoin_all(first);
  const RootNumber lifted = SqrtTower::lift(nested, roots), also = SqrtTower::lift(three, roots);
  equal((lifted * lifted - also - RootNumber(1)).sign(), 0);
  equal((lifted * two - second.adjoin_root(RootNumber(2) * also + RootNumber(2))).sign(), 0);
}
