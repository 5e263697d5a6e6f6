// What the envelope of a row gives: labels, squared distances, distances.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/numbers/int128.hpp"
#include "core/tessellation/row_kernel.hpp"

namespace vorotool::core::tessellation {

template <class Arithmetic>
void fill_labels(const RowKernel<Arithmetic>& kernel, const Envelope<Arithmetic>& envelope,
                 std::uint8_t* row) {
  kernel.fill8(envelope, row);
}
template <class Arithmetic>
void fill_labels(const RowKernel<Arithmetic>& kernel, const Envelope<Arithmetic>& envelope,
                 std::uint16_t* row) {
  kernel.fill16(envelope, row);
}
template <class Arithmetic>
void fill_labels(const RowKernel<Arithmetic>& kernel, const Envelope<Arithmetic>& envelope,
                 std::uint32_t* row) {
  kernel.fill32(envelope, row);
}

// Calls span(first pixel, last pixel, x, dy^2, label) for each candidate that is nearest on some pixel.
template <class Arithmetic, class Span>
void for_each_span(const Envelope<Arithmetic>& envelope, Span span) {
  using Integer = typename Arithmetic::Integer;
  std::int32_t start = 0;
  for (std::int32_t i = 0; i < envelope.count; ++i) {
    const std::int32_t end = envelope.end[i];
    if (end < start) continue;
    const auto x = static_cast<Integer>(envelope.candidates.x[i]);
    const auto value = static_cast<Integer>(envelope.candidates.value[i]);
    span(start, end, x, Arithmetic::filtered ? value * value : value - x * x);
    start = end + 1;
  }
}

// The largest integer whose square is at most v >= 0: a rounded root, corrected.
template <class Integer>
Integer integer_root(Integer v) {
  auto root = static_cast<Integer>(std::sqrt(static_cast<double>(v)));
  // One Newton step brings the 53-bit guess of a 128-bit root within one or two of the truth.
  if (root > 0) root = (root + v / root) / 2;
  while (root * root > v) --root;
  while ((root + 1) * (root + 1) <= v) ++root;
  return root;
}

template <class Integer>
Integer floor_over(Integer a, Integer positive) {
  const Integer quotient = a / positive;
  return a % positive < 0 ? quotient - 1 : quotient;
}

// A bound on squared distances in the integers of an arithmetic; beyond every distance it has no effect.
template <class Integer>
Integer clamped(numbers::uint128 most_squared) {
  constexpr numbers::uint128 largest = numbers::uint128{1}
                                       << (sizeof(Integer) * 8 - 3);  // its root and sums of three still fit
  return static_cast<Integer>(std::min(most_squared, largest));
}

// Sets the pixels beyond the distance to 0.
template <class Arithmetic, class Label>
void clear_beyond(const Envelope<Arithmetic>& envelope, const PixelRow& pixels,
                  typename Arithmetic::Integer most_squared, Label* row) {
  using Integer = typename Arithmetic::Integer;
  for_each_span(envelope, [&](std::int32_t first, std::int32_t last, Integer x, Integer dy2) {
    Integer from = Integer{last} + 1;
    Integer to = last;
    if (dy2 <= most_squared) {
      const Integer reach = integer_root<Integer>(most_squared - dy2);
      from = -floor_over<Integer>(reach - x, pixels.steps) + pixels.middle;  // ceil((x - reach) / steps)
      to = floor_over<Integer>(x + reach, pixels.steps) + pixels.middle;
    }
    const auto clamp = [&](Integer p) {
      return static_cast<std::int32_t>(std::clamp<Integer>(p, first, Integer{last} + 1));
    };
    std::fill(row + first, row + clamp(from), Label{0});
    std::fill(row + std::max(clamp(to + 1), first), row + last + 1, Label{0});
  });
}

// Calls put(pixel, squared distance) for every pixel of the row.
template <class Arithmetic, class Put>
void for_each_square(const Envelope<Arithmetic>& envelope, const PixelRow& pixels, Put put) {
  using Integer = typename Arithmetic::Integer;
  for_each_span(envelope, [&](std::int32_t first, std::int32_t last, Integer x, Integer dy2) {
    const Integer steps = pixels.steps;
    Integer dx = steps * (first - pixels.middle) - x;
    for (std::int32_t p = first; p <= last; ++p, dx += steps) put(p, dx * dx + dy2);
  });
}

}  // namespace vorotool::core::tessellation
