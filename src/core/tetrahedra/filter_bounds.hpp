// Bounds of the errors of determinants in floating point.
#pragma once

#include "core/numbers/sign.hpp"

namespace vorotool::core::tetrahedra {

using numbers::unit_roundoff;

// The filters. u = 2^-53 bounds the relative error of a rounding, h = 2^-1075 the absolute one of a product that
// underflows; differences and sums have no other error than u. An overflow makes the bound infinite or NaN, and
// nothing is greater than that.
//
// A monomial of orient3d meets 8 roundings (three differences, two products, three sums), one of in_sphere 16 (five
// differences, the product and the difference of a minor, the product and the two sums of a cofactor, three of a lift,
// the last product and two sums), and the permanent, the sum of the absolute monomials, as computed from rounded
// differences at most as many. So
//   |det - D| <= P ((1 + u)^n - 1) (1 - u)^-n <= P (n u + 2 n^2 u^2), and the rounding of k P takes n u^2 P more:
// k = n u + 4 n^2 u^2 is enough. (In P the factors are absolute differences, whose own roundings are in the 16 too.)
inline constexpr double orient_factor = (8 + 256 * unit_roundoff) * unit_roundoff;
inline constexpr double sphere_factor = (16 + 1024 * unit_roundoff) * unit_roundoff;

// Underflow in orient3d: each of six products of two costs h |z|, each of three products with z costs h, in all at most
// 2 h (|za| + |zb| + |zc|) + 3 h with the roundings that follow, 7 h (1 + |za| + |zb| + |zc|) in plenty; the term
// 2^-1000 (1 + ...) is worth 8 u 2^-1000 = 2^-1050 times the same.
inline constexpr double orient_guard = 0x1p-1000;

// Underflow in in_sphere: products of two cost h times a cubic factor of at most 6 M^3 (24 of them) or 9 M^3 (12
// coordinates squared), where no difference is larger than M; products with z cost h 3 M^2, the last ones h. With
// M <= 2^190 that is less than 2^9 h 2^570 = 2^-496; the guard is worth 16 u 2^-440 = 2^-489.
inline constexpr double largest_lift = 0x1p380;
inline constexpr double sphere_guard = 0x1p-440;

}  // namespace vorotool::core::tetrahedra
