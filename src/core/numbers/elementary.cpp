#include "core/numbers/elementary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace vorotool::core::numbers {
namespace {

// Of the power series: where z is at most 1/4 the terms from the next one on are below 2^-62 z.
constexpr std::size_t terms = 15;

template <int sign>
constexpr std::array<double, terms> series = [] {
  std::array<double, terms> coefficients{};
  double product = 1;
  for (std::size_t k = 0; k < terms; ++k) {
    const double odd = 2.0 * static_cast<double>(k) + 1;
    coefficients[k] = product / odd;
    product *= -sign * odd / (odd + 1);
  }
  return coefficients;
}();

// f(z) = 2 f(z / sqrt(2 (1 + sqrt(1 + sign z^2)))), of the inverse sine (sign -1) or hyperbolic sine, brings z,
// which is not negative, below 1/4, where the series is summed.
template <int sign>
double by_halves(double z) {
  double factor = 1;
  for (; z > 0.25; factor *= 2) {
    z /= std::sqrt(2 * (1 + std::sqrt(sign > 0 ? 1 + z * z : (1 - z) * (1 + z))));
  }
  double total = 0;
  for (std::size_t k = terms; k-- > 0;) total = total * (z * z) + series<sign>[k];
  return factor * z * total;
}

double in_range(double large, double small) {
  const double root = std::sqrt(large * large + small * small);
  if (root == 0) return 0;
  const bool is_even = root <= 2 * small;
  const double over = root - (is_even ? small : large);
  const double one = is_even ? large * (2 * over - large) : 2 * over * (large - 2 * small);
  const double two = is_even ? (over - 2 * (large - small)) * over : (4 * over - small) * small + over * over;
  return root - (one + two) / (2 * root);
}

}  // namespace

double hypotenuse(double x, double y) {
  const double large = std::max(std::abs(x), std::abs(y)), small = std::min(std::abs(x), std::abs(y));
  if (std::isinf(x) || std::isinf(y)) return std::numeric_limits<double>::infinity();
  if (std::isnan(x) || std::isnan(y)) return std::numeric_limits<double>::quiet_NaN();
  if (large == 0 || (large >= 0x1p-459 && large <= 0x1p511)) return in_range(large, small);
  int shift = 0;
  std::frexp(large, &shift);
  return std::ldexp(in_range(std::ldexp(large, -shift), std::ldexp(small, -shift)), shift);
}

double angle_of(double x, double y) {
  const double length = hypotenuse(x, y);
  if (!(length > 0)) return 0;
  double angle = by_halves<-1>(std::min(std::abs(x), y) / length);
  if (y > std::abs(x)) angle = std::numbers::pi / 2 - angle;
  return x < 0 ? std::numbers::pi - angle : angle;
}

double inverse_sinh(double z) { return by_halves<1>(z); }

}  // namespace vorotool::core::numbers
