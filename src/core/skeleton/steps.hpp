// Places at equal steps along the branches of a skeleton.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"
#include "core/skeleton/skeleton_view.hpp"

namespace vorotool::core::skeleton {

struct Steps {
  std::vector<std::int64_t> arc;                   // [n]
  std::vector<double> along;                       // [n] from the beginning of the branch
  std::vector<kernel::Point> place;                // [n]
  std::vector<double> radius;                      // [n]
  std::vector<std::array<kernel::Point, 2>> feet;  // [n] nearest on the closed sites left and right
};

// At 0, 1, 2 ... steps from the beginning of each branch, whose first arc and whose number of places are
// given.
Steps steps_along(const SkeletonView& skeleton, std::span<const std::int64_t> first,
                  std::span<const std::int64_t> counts, double every, unsigned threads,
                  const base::Monitor& monitor);

}  // namespace vorotool::core::skeleton
