// Differences of seeds as integers, and exact products of them.
//
// Coordinates are multiples of `seed_step` below 2^30 (core/sampled_skeleton/boundary_samples.hpp):
// differences are below 2^53 of these, products of two below 2^106, sums of two products below 2^107.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/kernel/point.hpp"
#include "core/numbers/int128.hpp"
#include "core/numbers/sign.hpp"
#include "core/sampled_skeleton/boundary_samples.hpp"

namespace vorotool::core::sampled_skeleton {

struct SeedVector {
  std::int64_t x, y;
};

inline SeedVector seed_difference(const kernel::Point& a, const kernel::Point& b) {
  return {static_cast<std::int64_t>((a.x - b.x) / seed_step),
          static_cast<std::int64_t>((a.y - b.y) / seed_step)};
}
inline SeedVector operator+(const SeedVector& v, const SeedVector& w) { return {v.x + w.x, v.y + w.y}; }
inline numbers::int128 dot(const SeedVector& v, const SeedVector& w) {
  return numbers::int128{v.x} * w.x + numbers::int128{v.y} * w.y;
}
inline SeedVector left_of(const SeedVector& v) { return {-v.y, v.x}; }

// The sign of the angle at p between a and b less 90 degrees, exactly: 1 if it is smaller.
inline int sign_of_dot(const kernel::Point& p, const kernel::Point& a, const kernel::Point& b) {
  // differences are exact, two products and a sum rounded
  const double x = (a.x - p.x) * (b.x - p.x), y = (a.y - p.y) * (b.y - p.y), sum = x + y;
  if (std::abs(sum) > 4 * numbers::unit_roundoff * (std::abs(x) + std::abs(y))) return numbers::sign_of(sum);
  const numbers::int128 exact = dot(seed_difference(a, p), seed_difference(b, p));
  return (exact > 0) - (exact < 0);
}

}  // namespace vorotool::core::sampled_skeleton
