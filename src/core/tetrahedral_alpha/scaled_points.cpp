#include "core/tetrahedral_alpha/scaled_points.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/numbers/dyadic_grid.hpp"
#include "core/tetrahedral_alpha/radius_bounds.hpp"

namespace vorotool::core::tetrahedral_alpha {

using bounds::infinity;

namespace {

constexpr std::size_t points_a_piece = std::size_t{1} << 14;

// The least and the greatest of all coordinates by axes, and the exponent of the last bit of any.
struct Extent {
  Point3 least{infinity, infinity, infinity}, most{-infinity, -infinity, -infinity};
  int exponent = 1024;

  void add(const Point3& low, const Point3& high, int last) {
    least = {std::min(least.x, low.x), std::min(least.y, low.y), std::min(least.z, low.z)};
    most = {std::max(most.x, high.x), std::max(most.y, high.y), std::max(most.z, high.z)};
    exponent = std::min(exponent, last);
  }

  double size() const { return std::max({most.x - least.x, most.y - least.y, most.z - least.z}); }
  double largest() const {
    return std::max({std::abs(least.x), std::abs(least.y), std::abs(least.z), std::abs(most.x),
                     std::abs(most.y), std::abs(most.z)});
  }
};

int last_exponent(double value) {
  const numbers::OddMantissa parts(value);
  return parts.mantissa == 0 ? 1024 : parts.exponent;
}

// Multiplies by a power of two as two doubles, since it may be none itself.
struct Scaling {
  explicit Scaling(int exponent)
      : first(std::ldexp(1.0, exponent / 2)), second(std::ldexp(1.0, exponent - exponent / 2)) {}
  double operator()(double value) const { return value * first * second; }

  double first, second;
};

}  // namespace

ScaledPoints::ScaledPoints(std::span<const Point3> given, std::span<const std::int32_t> chosen,
                           unsigned threads, const base::Monitor& monitor)
    : points(chosen.size()) {
  const auto for_pieces = [&](const auto& body) {
    base::for_pieces(chosen.size(), points_a_piece, threads, monitor, body);
  };
  std::vector<Extent> extents(base::piece_count(chosen.size(), points_a_piece));
  for_pieces([&](std::size_t piece, std::size_t begin, std::size_t end) {
    Extent extent;
    for (std::size_t i = begin; i < end; ++i) {
      const Point3& p = points[i] = given[base::at(chosen[i])];
      extent.add(p, p, std::min({last_exponent(p.x), last_exponent(p.y), last_exponent(p.z)}));
    }
    extents[piece] = extent;
  });
  Extent all;
  for (const Extent& each : extents) all.add(each.least, each.most, each.exponent);
  const double largest = all.largest();
  if (chosen.empty() || largest == 0) return;
  // Differences of multiples of 2^exponent below 2^(exponent + 53) are doubles, and so is the scaling.
  are_integers = all.size() < std::ldexp(1.0, all.exponent + 52);
  exponent = are_integers ? all.exponent : std::ilogb(largest);
  const Point3 origin = are_integers ? all.least : Point3{};
  const Scaling scaled(-exponent), back(exponent);
  std::atomic<bool> is_lost = false;
  for_pieces([&](std::size_t, std::size_t begin, std::size_t end) {
    bool is_same = true;
    for (std::size_t i = begin; i < end; ++i) {
      const Point3 moved{points[i].x - origin.x, points[i].y - origin.y, points[i].z - origin.z};
      const Point3 p = points[i] = {scaled(moved.x), scaled(moved.y), scaled(moved.z)};
      is_same &= back(p.x) == moved.x && back(p.y) == moved.y && back(p.z) == moved.z;
    }
    if (!is_same) is_lost = true;
  });
  if (!is_lost) return;
  exponent = 0;
  for_pieces([&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points[i] = given[base::at(chosen[i])];
  });
}

}  // namespace vorotool::core::tetrahedral_alpha
