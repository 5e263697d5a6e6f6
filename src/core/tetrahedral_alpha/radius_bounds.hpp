// Errors of the estimates of radii, and where they hold.
//
// To first order in u, with the errors of differences included, which are u each: squares of lengths carry 5 u, minors
// 4 u of the sum of their absolute terms, determinants 8 u, centers 12 u, heights 20 u (24 u the first); "of the sum
// of their absolute terms" each. The factors below leave room for what is of second order, and for that the sums of
// absolute terms are rounded themselves.
#pragma once

#include <limits>

namespace vorotool::core::tetrahedral_alpha {
namespace bounds {

inline constexpr double u = 0x1p-53;
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double determinant_error = 10 * u, center_error = 16 * u, height_error = 32 * u;
inline constexpr double normal_error = 6 * u, few_roundings = 16 * u;

// Three squares, of a triangle's sides, have errors of 5 u each, their sum has two roundings more, and the difference of
// it and twice one of them, which is nearly half of it where the sign is not clear, one more: 13 u of the sum.
inline constexpr double side_error = 20 * u, side_guard = 0x1p-1000;

// Sizes in this range let nothing overflow, and what underflows matter only where the guards say so.
inline constexpr double smallest = 0x1p-60, largest = 0x1p60;
inline constexpr double least_determinant = 0x1p-300;
inline constexpr double height_guard = 0x1p-700;

inline constexpr double worst_error = 0x1p-41;
inline constexpr double exact_limit = 0x1p52;  // integers that are sums of terms below it are doubles

// Bits of a radius that need not be right for it to be ranked.
inline constexpr int open_bits = 20;

}  // namespace bounds
}  // namespace vorotool::core::tetrahedral_alpha
