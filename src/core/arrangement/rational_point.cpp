#include "core/arrangement/rational_point.hpp"

#include <utility>

#include "core/numbers/int128.hpp"

namespace vorotool::core::arrangement {

using numbers::int128;
using numbers::uint128;

namespace {

int compare_fractions(std::uint64_t a, std::uint64_t a_denominator, std::uint64_t b,
                      std::uint64_t b_denominator) {
  const uint128 left = uint128{a} * b_denominator, right = uint128{b} * a_denominator;
  return (left > right) - (left < right);
}

// start + length numerator / denominator, denominator > 0, as a whole number and a fraction of the
// denominator. |length| < 2^31 and |numerator| < 2^63: the product is within 2^94.
std::pair<std::int32_t, std::uint64_t> along(std::int32_t start, std::int64_t length, std::int64_t numerator,
                                             std::int64_t denominator) {
  const int128 product = int128{length} * numerator;
  int128 whole = product / denominator, rest = product % denominator;
  if (rest < 0) {
    rest += denominator;
    --whole;
  }
  return {static_cast<std::int32_t>(start + whole), static_cast<std::uint64_t>(rest)};
}

// Bounds on the parameter of a point that runs along a segment, each closed or open. The numerators are below
// 2^33 in magnitude and the denominators below 2^33: products within 2^66.
class ParameterRange {
 public:
  // The points with low <= start + t step < high, where low and high are within 1 and the others below 2^32.
  void clip(std::int64_t start, std::int64_t step, std::int64_t low, std::int64_t high) {
    if (step == 0) {
      empty_ = empty_ || start < low || start >= high;
    } else if (step > 0) {
      raise({low - start, step, false});
      lower({high - start, step, true});
    } else {
      lower({start - low, -step, false});
      raise({start - high, -step, true});
    }
  }

  bool is_empty() const {
    if (empty_) return true;
    const int order = compare(least_, most_);
    return order > 0 || (order == 0 && (least_.is_open || most_.is_open));
  }

 private:
  struct Bound {
    std::int64_t numerator, denominator;
    bool is_open;
  };

  static int compare(const Bound& a, const Bound& b) {
    const int128 left = int128{a.numerator} * b.denominator, right = int128{b.numerator} * a.denominator;
    return (left > right) - (left < right);
  }

  void raise(const Bound& bound) {
    const int order = compare(bound, least_);
    if (order > 0 || (order == 0 && bound.is_open)) least_ = bound;
  }

  void lower(const Bound& bound) {
    const int order = compare(bound, most_);
    if (order < 0 || (order == 0 && bound.is_open)) most_ = bound;
  }

  Bound least_{0, 1, false}, most_{1, 1, false};
  bool empty_ = false;
};

std::int64_t magnitude(std::int64_t value) { return value < 0 ? -value : value; }

}  // namespace

int compare(const RationalPoint& p, const RationalPoint& q) {
  if (p.x != q.x) return p.x < q.x ? -1 : 1;
  if (const int order = compare_fractions(p.fraction_x, p.denominator, q.fraction_x, q.denominator)) {
    return order;
  }
  if (p.y != q.y) return p.y < q.y ? -1 : 1;
  return compare_fractions(p.fraction_y, p.denominator, q.fraction_y, q.denominator);
}

int compare(const RationalPoint& p, kernel::LatticePoint q) {
  if (p.x != q.x) return p.x < q.x ? -1 : 1;
  if (p.fraction_x != 0) return 1;
  if (p.y != q.y) return p.y < q.y ? -1 : 1;
  return p.fraction_y != 0 ? 1 : 0;
}

RationalPoint crossing_of(const LatticeSegment& s, const LatticeSegment& t) {
  const std::int64_t sx = std::int64_t{s.b.x} - s.a.x, sy = std::int64_t{s.b.y} - s.a.y;
  const std::int64_t tx = std::int64_t{t.b.x} - t.a.x, ty = std::int64_t{t.b.y} - t.a.y;
  const std::int64_t wx = std::int64_t{t.a.x} - s.a.x, wy = std::int64_t{t.a.y} - s.a.y;
  std::int64_t denominator = sx * ty - sy * tx;
  std::int64_t numerator = wx * ty - wy * tx;
  if (denominator < 0) {
    denominator = -denominator;
    numerator = -numerator;
  }
  const auto [x, fraction_x] = along(s.a.x, sx, numerator, denominator);
  const auto [y, fraction_y] = along(s.a.y, sy, numerator, denominator);
  return {x, y, fraction_x, fraction_y, static_cast<std::uint64_t>(denominator)};
}

// With d the direction of s, w = (p.x, p.y) - s.a and D the denominator, the sign is that of
//   D (d x w) + d.x fraction_y - d.y fraction_x.
// |d x w| <= 2 (2^31 - 2)^2 < 2^63 - 2^33 and D < 2^63, the others are below 2^31 2^63: in all below 2^126.
int side_of(const LatticeSegment& s, const RationalPoint& p) {
  const std::int64_t dx = std::int64_t{s.b.x} - s.a.x, dy = std::int64_t{s.b.y} - s.a.y;
  const std::int64_t whole = turn(s.a, s.b, {p.x, p.y});
  const int128 value = int128{whole} * p.denominator + int128{dx} * p.fraction_y - int128{dy} * p.fraction_x;
  return (value > 0) - (value < 0);
}

bool meets_cell(const LatticeSegment& s, kernel::LatticePoint c) {
  // the line misses the closed cell if its distance from the center is more than (|d.x| + |d.y|) / (2 |d|)
  const std::int64_t dx = std::int64_t{s.b.x} - s.a.x, dy = std::int64_t{s.b.y} - s.a.y;
  if (magnitude(turn(s.a, s.b, c)) > (magnitude(dx) + magnitude(dy)) / 2) return false;
  ParameterRange range;  // in half steps from the center, the cell is [-1, 1) both ways
  range.clip(2 * (std::int64_t{s.a.x} - c.x), 2 * dx, -1, 1);
  range.clip(2 * (std::int64_t{s.a.y} - c.y), 2 * dy, -1, 1);
  return !range.is_empty();
}

}  // namespace vorotool::core::arrangement
