// Sums of many doubles.
#pragma once

#include <cmath>

#include "core/numbers/expansion.hpp"

namespace vorotool::core::numbers {

// A sum of many terms, in two doubles; one once it is beyond their range.
struct LongSum {
  TwoTerms value{0, 0};

  void add(double term) {
    const TwoTerms sum = two_sum(value.head, term);
    value = std::isfinite(sum.head) ? two_sum(sum.head, sum.tail + value.tail) : TwoTerms{sum.head, 0};
  }
  void add(const LongSum& other) {
    add(other.value.head);
    add(other.value.tail);
  }
};

}  // namespace vorotool::core::numbers
