#include "core/segment_voronoi/discs/ties.hpp"

#include <cstddef>
#include <cstdint>

#include "core/numbers/big_integer.hpp"
#include "core/numbers/int128.hpp"

namespace vorotool::core::segment_voronoi::discs {

using kernel::cross;
using kernel::dot;
using kernel::LatticeSite;
using kernel::LatticeVector;
using kernel::left_of;
using kernel::norm2;
using numbers::BigInteger;
using numbers::int128;

namespace {

constexpr std::size_t count = 4;

// With Ni the lines' normals, Li their lengths and Hi the heights of some origin over them, times Li, a
// circle around v of radius r has Ni v + Hi = Li r. Three such equations have one solution if no two Ni have
// one direction; four have one if and only if the determinant of the rows (Ni, Hi, Li) is 0. That is a sum of
// Ai Li with integers Ai.
struct NormalRows {
  std::array<LatticeVector, count> normal;
  std::array<std::int64_t, count> height;

  explicit NormalRows(const std::array<LatticeSite, count>& segments) {
    for (std::size_t i = 0; i < count; ++i) {
      const LatticeVector along = segments[i].b - segments[i].a;
      normal[i] = left_of(along);
      height[i] = cross(along, segments[0].a - segments[i].a);
    }
  }

  bool are_along(std::size_t i, std::size_t j) const {
    return cross(normal[i], normal[j]) == 0 && dot(normal[i], normal[j]) > 0;
  }

  // Ai: the rows after i are a rotation of those without i, which does not change a determinant of three.
  BigInteger cofactor(std::size_t i) const {
    const std::size_t j = (i + 1) % count, k = (i + 2) % count, l = (i + 3) % count;
    const auto term = [&](std::size_t h, std::size_t m, std::size_t n) {
      return BigInteger(int128{height[h]} * cross(normal[m], normal[n]));
    };
    const BigInteger minor = term(j, k, l) + term(k, l, j) + term(l, j, k);
    return i % 2 == 0 ? minor : -minor;
  }
};

}  // namespace

// Roots of integers of which no two have a rational quotient are linearly independent over the rationals
// (Besicovitch 1940). So the sum is 0 if and only if it is for each class of commensurable lengths, and Li
// (Ai Li + Aj Lj + ...) = Ai Li Li + Aj Li Lj + ... is an integer.
bool is_one_circle(const std::array<LatticeSite, 4>& segments) {
  const NormalRows rows(segments);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      if (j - i != 3 && rows.are_along(i, j)) return false;
    }
  }
  std::array<bool, count> known{};
  for (std::size_t i = 0; i < count; ++i) {
    if (known[i]) continue;
    const BigInteger square(norm2(rows.normal[i]));
    BigInteger sum;
    for (std::size_t j = i; j < count; ++j) {
      if (known[j]) continue;
      const std::optional<BigInteger> lengths = integer_root(square * BigInteger(norm2(rows.normal[j])));
      if (!lengths) continue;
      known[j] = true;
      sum += rows.cofactor(j) * *lengths;
    }
    if (sum.sign() != 0) return false;
  }
  return true;
}

// With n across the touched segment and w = q - p the center is p + t n where t = |w|^2 / (2 n w) > 0, and
// (center - q) d has the sign of |w|^2 (n d) - 2 (n w) (w d). Both products are below 2^127
// (core/kernel/lattice.hpp).
std::optional<int> sign_along_from_end(const SegmentSites& sites, const VoronoiRecord& v, SiteIndex q,
                                       SiteIndex segment) {
  const int at = v.find(q);
  if (at < 0) return std::nullopt;
  for (const int touched : {following(at), preceding(at)}) {
    const SiteIndex own = v.sites[static_cast<std::size_t>(touched)];
    const SiteIndex p = v.sites[static_cast<std::size_t>(3 - at - touched)];
    if (!sites.is_end(own, p)) continue;
    const LatticeVector left = left_of(sites.segment(own).direction());
    const LatticeVector n = v.is_left(touched) ? left : -left;
    const LatticeVector w = sites.point(q) - sites.point(p), d = sites.direction_from(q, segment);
    const int128 a = int128{norm2(w)} * dot(n, d), b = 2 * int128{dot(n, w)} * dot(w, d);
    return (a > b) - (a < b);
  }
  return std::nullopt;
}

}  // namespace vorotool::core::segment_voronoi::discs
