#include "core/arrangement/hot_pixel_tree.hpp"

#include <algorithm>

#include "core/numbers/int128.hpp"

namespace vorotool::core::arrangement {

using numbers::int128;

HotPixelTree::HotPixelTree(std::span<const kernel::LatticePoint> points) {
  items_.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) items_.push_back({points[i], static_cast<std::int32_t>(i)});
  std::size_t widest = 1;  // nodes of a level; halving rounds up, so that a leaf holds at most leaf_size
  while (widest * leaf_size < points.size()) widest *= 2;
  boxes_.resize(2 * widest - 1);
  if (!items_.empty()) build(0, 0, items_.size());
}

void HotPixelTree::build(std::size_t node, std::size_t begin, std::size_t end) {
  Box box{items_[begin].point, items_[begin].point};
  for (std::size_t i = begin; i < end; ++i) {
    const kernel::LatticePoint p = items_[i].point;
    box = {{std::min(box.low.x, p.x), std::min(box.low.y, p.y)},
           {std::max(box.high.x, p.x), std::max(box.high.y, p.y)}};
  }
  boxes_[node] = box;
  if (end - begin <= leaf_size) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const bool is_wide = std::int64_t{box.high.x} - box.low.x > std::int64_t{box.high.y} - box.low.y;
  const auto at = [this](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [is_wide](const Item& a, const Item& b) {
    return is_wide ? a.point.x < b.point.x : a.point.y < b.point.y;
  });
  build(2 * node + 1, begin, middle);
  build(2 * node + 2, middle, end);
}

// Whether a segment may meet a cell of a point of a box: unless one of the directions x, y and across the
// segment separates it from the union of the cells. In half steps; the numbers of the last test are below
// 2^66.
bool HotPixelTree::may_meet(const Box& box, const LatticeSegment& s) {
  const auto [low_x, high_x] = std::minmax(s.a.x, s.b.x);
  const auto [low_y, high_y] = std::minmax(s.a.y, s.b.y);
  // a cell reaches half a step beyond its point, and segments end at lattice points
  if (low_x > box.high.x || high_x < box.low.x || low_y > box.high.y || high_y < box.low.y) return false;
  const std::int64_t dx = std::int64_t{s.b.x} - s.a.x, dy = std::int64_t{s.b.y} - s.a.y;
  const std::int64_t x = std::int64_t{box.low.x} + box.high.x - 2 * std::int64_t{s.a.x};
  const std::int64_t y = std::int64_t{box.low.y} + box.high.y - 2 * std::int64_t{s.a.y};
  const std::int64_t width = std::int64_t{box.high.x} - box.low.x + 1;
  const std::int64_t height = std::int64_t{box.high.y} - box.low.y + 1;
  const int128 distance = int128{dx} * y - int128{dy} * x;
  const int128 reach = int128{dx < 0 ? -dx : dx} * height + int128{dy < 0 ? -dy : dy} * width;
  return (distance < 0 ? -distance : distance) <= reach;
}

}  // namespace vorotool::core::arrangement
