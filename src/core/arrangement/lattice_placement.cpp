#include "core/arrangement/lattice_placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.hpp"

namespace vorotool::core::arrangement {

using kernel::Point;

namespace {

constexpr std::size_t points_per_piece = std::size_t{1} << 16;  // about a millisecond
constexpr int finest_exponent = -1074;  // every finite double is a multiple of this power of two

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }

  void include(const Range& other) {
    include(other.low);
    include(other.high);
  }

  // Halves first: the sum or difference of two doubles may be beyond the largest.
  double middle() const { return low / 2 + high / 2; }
  double half_width() const { return high / 2 - low / 2; }
};

struct Bounds {
  Range x, y;

  void include(std::span<const Point> points) {
    for (const Point& point : points) {
      x.include(point.x);
      y.include(point.y);
    }
  }

  void include(const Bounds& other) {
    x.include(other.x);
    y.include(other.y);
  }
};

// The multiple of 2^exponent nearest to a double. One of 2^53 steps or more is a multiple already.
double nearest_multiple(double value, int exponent) {
  const double steps = std::ldexp(value, -exponent);
  if (!(std::abs(steps) < 0x1p53)) return value;
  return std::ldexp(std::nearbyint(steps), exponent);
}

struct Placed {
  double steps;  // whole
  double move;   // its distance from the value in steps, 0 or rounded up
};

// One axis of a lattice: both the origin and the values are doubles, so that everything is exact in pairs.
class Axis {
 public:
  Axis(double origin, int exponent) : origin_(origin), exponent_(exponent) {}

  Placed place(double value) const {
    // value - origin = difference + error, exactly (Knuth): |value - origin| is at most half the extent
    const double difference = value - origin_;
    const double back = difference - value;
    const double error = (value - (difference - back)) - (origin_ + back);
    const double steps = std::ldexp(difference, -exponent_);
    double nearest = std::nearbyint(steps);
    if (std::ldexp(nearest, exponent_) == difference && error == 0) return {nearest, 0};
    const double rest = steps - nearest;  // exact: a multiple of the last bit of steps, at most 1/2
    const double error_steps = std::ldexp(error, -exponent_);
    // two roundings at most (here, and in ldexp where it underflows): two steps up are beyond both
    const double upper = std::abs(rest + error_steps);
    const double infinity = std::numeric_limits<double>::infinity();
    return {nearest, std::nextafter(std::nextafter(upper, infinity), infinity)};
  }

 private:
  double origin_;
  int exponent_;
};

bool fits(const Axis& axis, const Range& range) {
  // rounding is monotone: what holds for the ends holds for all
  return std::abs(axis.place(range.low).steps) <= kernel::lattice_limit &&
         std::abs(axis.place(range.high).steps) <= kernel::lattice_limit;
}

// The length of a vector of non-negative components, rounded up. Its sum of squares has a relative error of
// at most 2 u, the root one more; where squares may have lost bits by underflow, the sum is used, which is
// larger.
double length_above(double x, double y) {
  if (x == 0 || y == 0) return x + y;
  if (x < 0x1p-500 && y < 0x1p-500) return x + y;
  return std::sqrt(x * x + y * y) * (1 + 0x1p-50);
}

void choose_lattice(const Bounds& bounds, Placement& lattice) {
  // half the extent is below 2^k: below 2^30 steps of 2^(k - 30); rounding may make that 2^30, and steps
  // twice as long are enough then
  int k = 0;
  const double half = std::max(bounds.x.half_width(), bounds.y.half_width());
  std::frexp(half, &k);
  for (int exponent = half == 0 ? finest_exponent : std::max(k - 30, finest_exponent);; ++exponent) {
    lattice.exponent = exponent;
    lattice.origin_x = nearest_multiple(bounds.x.middle(), exponent);
    lattice.origin_y = nearest_multiple(bounds.y.middle(), exponent);
    if (fits({lattice.origin_x, exponent}, bounds.x) && fits({lattice.origin_y, exponent}, bounds.y)) return;
  }
}

}  // namespace

Placement place_on_lattice(std::span<const Point> points, unsigned threads, const base::Monitor& monitor) {
  Placement result;
  if (points.empty()) return result;
  const std::size_t pieces = base::piece_count(points.size(), points_per_piece);
  std::vector<Bounds> bounds(pieces);
  const auto measure = [&](std::size_t piece, std::size_t begin, std::size_t end) {
    bounds[piece].include(points.subspan(begin, end - begin));
  };
  base::for_pieces(points.size(), points_per_piece, threads, monitor, measure);
  for (const Bounds& each : bounds) bounds[0].include(each);
  choose_lattice(bounds[0], result);
  const Axis along_x(result.origin_x, result.exponent), along_y(result.origin_y, result.exponent);
  result.points.resize(points.size());
  std::vector<double> most(pieces, 0);
  const auto place = [&](std::size_t piece, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Placed px = along_x.place(points[i].x), py = along_y.place(points[i].y);
      result.points[i] = {static_cast<std::int32_t>(px.steps), static_cast<std::int32_t>(py.steps)};
      most[piece] = std::max(most[piece], length_above(px.move, py.move));
    }
  };
  base::for_pieces(points.size(), points_per_piece, threads, monitor, place);
  const double steps = *std::max_element(most.begin(), most.end());
  result.largest_move = std::ldexp(steps, result.exponent);
  if (steps > 0) {  // ldexp rounds where the result is subnormal
    result.largest_move = std::nextafter(result.largest_move, std::numeric_limits<double>::infinity());
  }
  return result;
}

}  // namespace vorotool::core::arrangement
