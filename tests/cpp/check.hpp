// What the tests of the core's own functions need: tests by name, checks that print what failed and where,
// and numbers that are the same on every machine.
#pragma once

#include <cstdint>
#include <iostream>
#include <random>
#include <vector>

namespace vorotool::tests {

struct Test {
  const char* name;
  void (*run)();
};
inline std::vector<Test> tests;
inline int faults = 0;

struct Registration {
  Registration(const char* name, void (*run)()) { tests.push_back({name, run}); }
};
#define TEST(name)                                                    \
  static void name();                                                 \
  static const vorotool::tests::Registration name##_is_(#name, name); \
  static void name()

// As std::source_location, which Clang 14 has not.
struct Where {
  const char* file;
  int line;
  static Where current(const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
    return {file, line};
  }
};

inline std::ostream& fault(const Where& where) {
  ++faults;
  return std::cout << where.file << ':' << where.line << ": ";
}

#define CHECK(...) vorotool::tests::holds(static_cast<bool>(__VA_ARGS__), #__VA_ARGS__)
inline void holds(bool is_true, const char* what, const Where& where = Where::current()) {
  if (!is_true) fault(where) << "not " << what << '\n';
}

template <class Got, class Right>
void equal(const Got& got, const Right& right, const Where& where = Where::current()) {
  if (!(got == right)) fault(where) << got << ", not " << right << '\n';
}

// Whole numbers from least to most, in the same order wherever they are drawn.
class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  std::int64_t whole(std::int64_t least, std::int64_t most) {
    const auto range = static_cast<std::uint64_t>(most) - static_cast<std::uint64_t>(least) + 1;
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(least) +
                                     (range == 0 ? bits_() : bits_() % range));
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace vorotool::tests
