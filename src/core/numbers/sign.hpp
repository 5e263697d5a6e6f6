// Signs, and what stands for one that is not known yet.
#pragma once

#include <cstdint>

namespace vorotool::core::numbers {

inline int sign_of(double value) { return (value > 0) - (value < 0); }
inline int sign_of(std::int64_t value) { return (value > 0) - (value < 0); }

// The result of a filter that cannot tell the sign.
inline constexpr int undecided = 2;

// 2^-53 bounds the relative error of a rounding.
inline constexpr double unit_roundoff = 0x1p-53;

}  // namespace vorotool::core::numbers
