// Pairs of straight edges whose bounding boxes meet, by a balanced tree of boxes over edges that lie near each
// other when their numbers do.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/kernel/point.hpp"

namespace vorotool::core::arrangement {

struct Edge {
  kernel::Point a, b;
};

class EdgeTree {
 public:
  explicit EdgeTree(std::span<const Edge> edges) : edges_(edges) {
    std::vector<Box> boxes;
    for (std::size_t begin = 0; begin < edges.size(); begin += leaf) {
      Box box = box_of(edges[begin]);
      for (std::size_t i = begin + 1; i < std::min(begin + leaf, edges.size()); ++i) {
        box = hull(box, box_of(edges[i]));
      }
      boxes.push_back(box);
    }
    while (boxes.size() > 1) {
      std::vector<Box> above;
      for (std::size_t i = 0; i < boxes.size(); i += 2) {
        above.push_back(i + 1 < boxes.size() ? hull(boxes[i], boxes[i + 1]) : boxes[i]);
      }
      levels_.push_back(std::move(boxes));
      boxes = std::move(above);
    }
    levels_.push_back(std::move(boxes));
  }

  // Calls meet(i, j) with i < j for all pairs of edges whose boxes meet, until it returns false.
  template <class Meet>
  bool all_pairs(const Meet& meet) const {
    return edges_.empty() || within(levels_.size() - 1, 0, meet);
  }

 private:
  struct Box {
    double left, bottom, right, top;
  };
  static constexpr std::size_t leaf = 8;

  static Box box_of(const Edge& edge) {
    const auto [left, right] = std::minmax(edge.a.x, edge.b.x);
    const auto [bottom, top] = std::minmax(edge.a.y, edge.b.y);
    return {left, bottom, right, top};
  }
  static Box hull(const Box& p, const Box& q) {
    return {std::min(p.left, q.left), std::min(p.bottom, q.bottom), std::max(p.right, q.right),
            std::max(p.top, q.top)};
  }
  static bool touch(const Box& p, const Box& q) {
    return p.left <= q.right && q.left <= p.right && p.bottom <= q.top && q.bottom <= p.top;
  }

  template <class Meet>
  bool within(std::size_t level, std::size_t i, const Meet& meet) const {
    if (level == 0) return edges_of(i, i, meet);
    const std::size_t first = 2 * i, second = first + 1;
    if (!within(level - 1, first, meet)) return false;
    return second >= levels_[level - 1].size() ||
           (within(level - 1, second, meet) && between(level - 1, first, second, meet));
  }

  template <class Meet>
  bool between(std::size_t level, std::size_t i, std::size_t j, const Meet& meet) const {
    if (!touch(levels_[level][i], levels_[level][j])) return true;
    if (level == 0) return edges_of(i, j, meet);
    const std::size_t end = levels_[level - 1].size();
    for (std::size_t p = 2 * i; p < std::min(2 * i + 2, end); ++p) {
      for (std::size_t q = 2 * j; q < std::min(2 * j + 2, end); ++q) {
        if (!between(level - 1, p, q, meet)) return false;
      }
    }
    return true;
  }

  template <class Meet>
  bool edges_of(std::size_t i, std::size_t j, const Meet& meet) const {
    for (std::size_t p = i * leaf; p < std::min((i + 1) * leaf, edges_.size()); ++p) {
      const Box box = box_of(edges_[p]);
      if (i != j && !touch(box, levels_[0][j])) continue;
      for (std::size_t q = std::max(p + 1, j * leaf); q < std::min((j + 1) * leaf, edges_.size()); ++q) {
        if (touch(box, box_of(edges_[q])) && !meet(p, q)) return false;
      }
    }
    return true;
  }

  std::span<const Edge> edges_;
  std::vector<std::vector<Box>> levels_;  // from the leaves up
};

}  // namespace vorotool::core::arrangement
