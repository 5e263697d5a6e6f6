#include "core/point_order.hpp"

#include <algorithm>
#include <cmath>

#include "core/radix_sort.hpp"

namespace vorotool::core {

namespace {

// 16 bits of each coordinate: enough to tell most points apart, and three passes of the sort.
constexpr int cell_bits = 16;

// Puts the 16 bits of v at the even places.
std::uint32_t spread(std::uint32_t v) {
  v = (v | v << 8) & 0x00ff00ffU;
  v = (v | v << 4) & 0x0f0f0f0fU;
  v = (v | v << 2) & 0x33333333U;
  return (v | v << 1) & 0x55555555U;
}

// Numbers the cells of one coordinate; both coordinates have cells of one size. Every step rounds
// monotonically, so a smaller cell means a smaller coordinate. Halves keep the range of the largest doubles
// finite.
class Cells {
 public:
  Cells(double least, double half_range) : least_(least / 2) {
    // A range below 2^-960 is blown up in two exact steps, where one factor would be infinite.
    blow_up_ = half_range < 0x1p-960 ? 0x1p120 : 1.0;
    factor_ = half_range > 0 ? last / (half_range * blow_up_) : 0.0;
  }

  std::uint32_t operator()(double v) const {
    return static_cast<std::uint32_t>(std::min((v / 2 - least_) * blow_up_ * factor_, last));
  }

 private:
  static constexpr double last = (1 << cell_bits) - 1;
  double least_, blow_up_, factor_;
};

struct Bounds {
  Point least, most;
};

Bounds bounds_of(std::span<const Point> points) {
  Bounds bounds{points.front(), points.front()};
  for (const Point& p : points) {
    bounds.least = {std::min(bounds.least.x, p.x), std::min(bounds.least.y, p.y)};
    bounds.most = {std::max(bounds.most.x, p.x), std::max(bounds.most.y, p.y)};
  }
  return bounds;
}

// A word holds the code of a point above its index.
std::uint32_t code_of(std::uint64_t word) { return static_cast<std::uint32_t>(word >> 32); }
std::uint32_t index_of(std::uint64_t word) { return static_cast<std::uint32_t>(word); }

bool same_place(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }

// Appends the points of one cell, sorted by place and then index, without those at a place that is already
// there.
void append_cell(std::span<const Point> points, std::span<std::uint64_t> cell, std::span<std::int32_t> first,
                 MortonOrder& order) {
  if (cell.size() > 1) {
    std::sort(cell.begin(), cell.end(), [&](std::uint64_t a, std::uint64_t b) {
      const Point& p = points[index_of(a)];
      const Point& q = points[index_of(b)];
      if (p.x != q.x) return p.x < q.x;
      return p.y != q.y ? p.y < q.y : a < b;
    });
  }
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const std::uint32_t index = index_of(cell[i]);
    const Point& p = points[index];
    const bool repeated = i > 0 && same_place(p, order.points.back());
    if (!repeated) {
      order.points.push_back(p);
      order.index.push_back(index);
      order.code.push_back(code_of(cell[i]));
    }
    first[index] = static_cast<std::int32_t>(order.index.back());
  }
}

}  // namespace

MortonOrder morton_order(std::span<const Point> points, std::span<std::int32_t> first) {
  MortonOrder order;
  if (points.empty()) return order;
  const Bounds bounds = bounds_of(points);
  const double half_range =
      std::max(bounds.most.x / 2 - bounds.least.x / 2, bounds.most.y / 2 - bounds.least.y / 2);
  const Cells column(bounds.least.x, half_range);
  const Cells row(bounds.least.y, half_range);
  std::vector<std::uint64_t> words(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t code = spread(column(points[i].x)) << 1 | spread(row(points[i].y));
    words[i] = std::uint64_t{code} << 32 | i;
  }
  radix_sort(words, 32, 32 + 2 * cell_bits);
  order.points.reserve(points.size());
  order.index.reserve(points.size());
  order.code.reserve(points.size());
  for (std::size_t begin = 0; begin < words.size();) {
    std::size_t end = begin + 1;
    while (end < words.size() && code_of(words[end]) == code_of(words[begin])) ++end;
    append_cell(points, std::span(words).subspan(begin, end - begin), first, order);
    begin = end;
  }
  return order;
}

}  // namespace vorotool::core
