#include "core/segment_voronoi/discs/four_segment_ties.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/kernel/lattice_vector.hpp"
#include "core/numbers/big_integer.hpp"

namespace vorotool::core::segment_voronoi::discs {

using kernel::cross;
using numbers::BigInteger;

namespace {

constexpr std::size_t count = 4;

// With Ni the lines' normals, Li their lengths and Hi the heights of some origin over them, times Li, a
// circle around v of radius r has Ni v + Hi = Li r. Three such equations have one solution if no two Ni have
// one direction; four have one if and only if the determinant of the rows (Ni, Hi, Li) is 0. That is a sum of
// Ai Li with integers Ai.
struct Rows {
  std::array<kernel::LatticeVector, count> normal;
  std::array<std::int64_t, count> height;

  explicit Rows(const std::array<kernel::LatticeSite, count>& segments) {
    for (std::size_t i = 0; i < count; ++i) {
      const kernel::LatticeVector along = segments[i].b - segments[i].a;
      normal[i] = kernel::left_of(along);
      height[i] = cross(along, segments[0].a - segments[i].a);
    }
  }

  bool are_along(std::size_t i, std::size_t j) const {
    return cross(normal[i], normal[j]) == 0 && kernel::dot(normal[i], normal[j]) > 0;
  }

  // Ai: the rows after i are a rotation of those without i, which does not change a determinant of three.
  BigInteger cofactor(std::size_t i) const {
    const std::size_t j = (i + 1) % count, k = (i + 2) % count, l = (i + 3) % count;
    const auto term = [&](std::size_t h, std::size_t m, std::size_t n) {
      return BigInteger(numbers::int128{height[h]} * cross(normal[m], normal[n]));
    };
    const BigInteger minor = term(j, k, l) + term(k, l, j) + term(l, j, k);
    return i % 2 == 0 ? minor : -minor;
  }
};

}  // namespace

// Roots of integers of which no two have a rational quotient are linearly independent over the rationals
// (Besicovitch 1940). So the sum is 0 if and only if it is for each class of commensurable lengths, and Li
// (Ai Li + Aj Lj + ...) = Ai Li Li + Aj Li Lj + ... is an integer.
bool is_one_circle(const std::array<kernel::LatticeSite, 4>& segments) {
  const Rows rows(segments);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      if (j - i != 3 && rows.are_along(i, j)) return false;
    }
  }
  std::array<bool, count> known{};
  for (std::size_t i = 0; i < count; ++i) {
    if (known[i]) continue;
    const BigInteger square(kernel::norm2(rows.normal[i]));
    BigInteger sum;
    for (std::size_t j = i; j < count; ++j) {
      if (known[j]) continue;
      const std::optional<BigInteger> lengths =
          integer_root(square * BigInteger(kernel::norm2(rows.normal[j])));
      if (!lengths) continue;
      known[j] = true;
      sum += rows.cofactor(j) * *lengths;
    }
    if (sum.sign() != 0) return false;
  }
  return true;
}

}  // namespace vorotool::core::segment_voronoi::discs
