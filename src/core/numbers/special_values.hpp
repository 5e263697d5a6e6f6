// The doubles that are not numbers of the line.
#pragma once

#include <limits>

namespace vorotool::core::numbers {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace vorotool::core::numbers
