// Of each site, the nearest other one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"

namespace vorotool::core::spatial {

struct NearestOther {
  std::int64_t index;  // in the input; -1 when there is no other site
  double distance;     // square root of the rounded sum of squares; NaN when there is no other site
};

// The nearest other site of each site by Euclidean distance, ties (of the squared distances in double) to the
// smallest label; another site at the same place is at distance 0. Coordinates are finite and at most 2^500
// in magnitude; there are two axes or three.
template <std::size_t Axes>
std::vector<NearestOther> nearest_other_sites(const std::array<std::span<const double>, Axes>& columns,
                                              std::span<const std::uint32_t> labels, unsigned threads,
                                              const base::Monitor& monitor);

}  // namespace vorotool::core::spatial
