// Ranks of radii by their exact values, of which equal ones share a rank.
#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <span>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/numbers/double_double.hpp"

namespace vorotool::core::alpha {

struct RadiusRanks {
  base::LargeArray<double> value;          // [m] not decreasing; equal where two exact values have one double
  base::LargeArray<std::int32_t> witness;  // [m] an item with this value
  // [2 n] first the place of each item in the above, m of those left out; the second half is memory to be used.
  base::LargeArray<std::int32_t> rank;
};

// Compares items with one: signs of the differences of the exact values of items and that of this one, whose doubles, as
// far as they count, are equal.
using CompareItem = std::function<int(std::uint32_t)>;
using CompareItems = std::function<CompareItem(std::uint32_t)>;

// The square of the exact value of an item, within an error that may be infinite.
struct FineRadius {
  numbers::DoubleDouble square;
  double error = 0;
};
using RefineItem = std::function<FineRadius(std::uint32_t)>;

// A positive double rounded so that its last bits are 0.
inline double rounded_by(int bits, double value) {
  const std::uint64_t unit = std::uint64_t{1} << bits;
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(value) + unit / 2) & ~(unit - 1));
}

// The items are 0 ... n - 1, n < 2^31, and values[i] is the double nearest to the exact value of item i, not
// a NaN; items with negative values are left out. Time is linear for values spread like radii, n log n at
// worst. Where `open_bits` is more than 0, a value need only be such that rounded by these it is what the exact one is.
// With `refine` fewer are compared exactly. The values given back are in the unit: times this power of two.
RadiusRanks rank_radii(std::span<const double> values, const CompareItems& compare, unsigned threads,
                       const base::Monitor& monitor, int open_bits = 0, const RefineItem& refine = {},
                       double unit = 1);

// The same in the memory of the values, which are gone.
RadiusRanks rank_radii(base::LargeArray<double>&& values, const CompareItems& compare, unsigned threads,
                       const base::Monitor& monitor, int open_bits, const RefineItem& refine, double unit);

}  // namespace vorotool::core::alpha
