// Indices of arrays, which are 32 bits wide everywhere.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

namespace vorotool::core::base {

using IndexPair = std::array<std::int32_t, 2>;

inline constexpr std::int32_t no_index = -1;

inline std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

// Throws std::invalid_argument where an index is less than `least`, or not less than `end`. Looks at all of
// them: without an early end several are compared at a time.
inline void check_range(std::span<const std::int32_t> indices, std::int32_t least, std::size_t end,
                        const char* what) {
  const auto last = static_cast<std::int32_t>(end) - 1;
  bool outside = false;
  for (const std::int32_t i : indices) outside |= (i < least) | (i > last);
  if (outside) throw std::invalid_argument(what);
}
inline void check_range(std::span<const IndexPair> pairs, std::int32_t least, std::size_t end,
                        const char* what) {
  if (!pairs.empty()) check_range({pairs.front().data(), 2 * pairs.size()}, least, end, what);
}

}  // namespace vorotool::core::base
