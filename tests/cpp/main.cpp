#include <cstdlib>
#include <exception>

#include "check.hpp"

using namespace vorotool::tests;

// Runs all tests and names those that failed. Seventeen digits tell every double from its neighbors.
int main() {
  std::cout.precision(17);
  int failed = 0;
  for (const auto& [name, run] : tests) {
    const int before = faults;
    try {
      run();
    } catch (const std::exception& error) {
      ++faults;
      std::cout << error.what() << '\n';
    }
    if (faults == before) continue;
    ++failed;
    std::cout << "FAILED " << name << '\n';
  }
  std::cout << tests.size() << " tests, " << failed << " failed\n";
  return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
