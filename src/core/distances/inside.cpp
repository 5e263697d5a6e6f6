#include "core/distances/inside.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vorotool::core::distances {

using kernel::Point;

namespace {

struct Square {
  Point center;
  double half;  // of a side

  // From the center to any place of it, with more than what rounding takes away.
  double reach() const { return half * 1.4142135623731 * (1 + 0x1p-40); }
};

enum class Known { no, yes, unknown };

// Whether a square has a place inside one shape that is farther than `least` from another.
Known goes_farther(const Square& square, const Shape& of, const Shape& to, double least) {
  const double reach = square.reach();
  const double apart = std::sqrt(to.tree().nearest(square.center).d2);
  if (to.contains(square.center)) return apart > reach || reach <= least ? Known::no : Known::unknown;
  if (apart + reach <= least * (1 - 0x1p-40)) return Known::no;
  if (of.contains(square.center)) return apart > least ? Known::yes : Known::unknown;
  return std::sqrt(of.tree().nearest(square.center).d2) > reach ? Known::no : Known::unknown;
}

}  // namespace

bool may_go_farther_inside(const Shape& of, const Shape& to, double least, std::size_t most,
                           const base::Monitor& monitor) {
  if (!of.is_filled()) return false;
  const Box& box = of.tree().node(of.tree().root()).box;
  const double width = box.high.x - box.low.x, height = box.high.y - box.low.y;
  // Smaller squares are places, but for rounding.
  const double smallest = 0x1p-50 * std::max({std::abs(box.low.x), std::abs(box.low.y), std::abs(box.high.x),
                                              std::abs(box.high.y)});
  std::vector<Square> open{
      {{box.low.x + 0.5 * width, box.low.y + 0.5 * height}, 0.5 * std::max(width, height)}};
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (i == most) return true;
    base::report_item(monitor, i, most);
    const Square square = open[i];
    const Known known = goes_farther(square, of, to, least);
    if (known == Known::yes) return true;
    if (known == Known::no) continue;
    const double half = 0.5 * square.half;
    if (half < smallest) continue;
    for (const Point& way : std::array<Point, 4>{{{-1, -1}, {1, -1}, {-1, 1}, {1, 1}}})
      open.push_back({{square.center.x + way.x * half, square.center.y + way.y * half}, half});
  }
  return false;
}

}  // namespace vorotool::core::distances
