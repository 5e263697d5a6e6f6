// Checks that fail, for tests/cpp/test_cpp.py.
#include <stdexcept>

#include "check.hpp"

using vorotool::tests::equal;

TEST(one_that_holds) { equal(2 + 2, 4); }

TEST(two_that_do_not) {
  equal(2 + 2, 5);
  CHECK(2 > 3);
}
TEST(one_that_ends_early) { throw std::runtime_error("thrown"); }
