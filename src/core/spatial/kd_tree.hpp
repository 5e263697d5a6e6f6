// A k-d tree over labelled points that answers "which label is nearest" exactly, ties to the smallest label.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <type_traits>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/numbers/int128.hpp"

namespace vorotool::core::spatial {

// Coordinates and squared distances of a KdTree, with their bounds:
// - std::int64_t, std::uint64_t: exact while coordinates differ by at most 2^31: 2 * (2^31)^2 < 2^64;
// - std::int64_t, uint128: exact while coordinates are at most 2^62: 2 * (2^63)^2 < 2^128;
// - double, double: the minimum of squared distances as they are rounded, exact where they need at most 53
//   bits. The search adds no error of its own: rounding is monotonic, so the rounded distance to a box never
//   exceeds that to a point in it.
template <class Coordinate, class Distance>
class KdTree {
 public:
  struct Site {
    Coordinate x;
    Coordinate y;
    std::uint32_t label;
    std::uint32_t index;  // position in the input
  };

  // Beyond every distance. (In strict C++ numeric_limits does not know 128 bits.)
  static constexpr Distance farthest() {
    if constexpr (std::is_floating_point_v<Distance>) return std::numeric_limits<Distance>::infinity();
    return static_cast<Distance>(-1);
  }

  // The best of a query so far: the smallest (d2, label), then the place in the tree, -1 for none.
  struct Nearest {
    Distance d2 = farthest();
    std::uint32_t label = UINT32_MAX;
    std::ptrdiff_t place = -1;
  };

  // Polls the monitor; sorting a million points takes some tenths of a second. At most 2^32 - 1 points.
  KdTree(std::span<const Coordinate> x, std::span<const Coordinate> y, std::span<const std::uint32_t> labels,
         const base::Monitor& monitor) {
    sites_.resize(labels.size());
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      sites_[i] = {x[i], y[i], labels[i], static_cast<std::uint32_t>(i)};
    }
    std::size_t leaves = 1;
    while (leaves * leaf_size < sites_.size()) leaves *= 2;
    boxes_.resize(2 * leaves - 1);
    first_leaf_ = leaves - 1;
    if (!sites_.empty()) build(0, 0, sites_.size(), monitor);
  }

  std::size_t size() const { return sites_.size(); }
  const Site& site(std::ptrdiff_t place) const { return sites_[static_cast<std::size_t>(place)]; }

  static Distance distance2(const Site& site, Coordinate x, Coordinate y) {
    return square(gap(site.x, x)) + square(gap(site.y, y));
  }

  // The start of a query at (x, y) from a site that is likely to be near: a good bound from the beginning.
  Nearest bound(std::ptrdiff_t place, Coordinate x, Coordinate y) const {
    return {distance2(site(place), x, y), site(place).label, place};
  }

  // Lexicographic minimum of (d2, label) over all sites but the one with index `except`, and `best`.
  Nearest nearest(Coordinate x, Coordinate y, Nearest best = {}, std::int64_t except = -1) const {
    if (!sites_.empty()) search(0, 0, sites_.size(), {x, y, except}, best);
    return best;
  }

 private:
  static constexpr std::size_t leaf_size = 8;  // sites a leaf at most

  // Node k has the children 2k + 1 and 2k + 2, which halve its range of sites.
  struct Box {
    Coordinate left, right, top, bottom;
    std::uint32_t least_label;
  };
  struct Query {
    Coordinate x, y;
    std::int64_t except;
  };

  static Distance gap(Coordinate a, Coordinate b) {
    if constexpr (std::is_integral_v<Coordinate>) {
      // Unsigned differences do not overflow, whatever the operands.
      const auto u = static_cast<std::uint64_t>(a);
      const auto v = static_cast<std::uint64_t>(b);
      return a < b ? v - u : u - v;
    } else {
      return a < b ? b - a : a - b;
    }
  }
  static Distance square(Distance length) { return length * length; }

  static Distance box_distance2(const Box& box, Coordinate x, Coordinate y) {
    return square(gap(x, std::clamp(x, box.left, box.right))) +
           square(gap(y, std::clamp(y, box.top, box.bottom)));
  }

  void build(std::size_t node, std::size_t first, std::size_t last, const base::Monitor& monitor) {
    if (last - first > 4096) base::report(monitor, 0);
    Box box{sites_[first].x, sites_[first].x, sites_[first].y, sites_[first].y, UINT32_MAX};
    for (std::size_t i = first; i < last; ++i) {
      box.left = std::min(box.left, sites_[i].x);
      box.right = std::max(box.right, sites_[i].x);
      box.top = std::min(box.top, sites_[i].y);
      box.bottom = std::max(box.bottom, sites_[i].y);
      box.least_label = std::min(box.least_label, sites_[i].label);
    }
    boxes_[node] = box;
    if (node >= first_leaf_) return;
    const std::size_t middle = std::midpoint(first, last);
    split(first, middle, last, gap(box.left, box.right) >= gap(box.top, box.bottom));
    build(2 * node + 1, first, middle, monitor);
    build(2 * node + 2, middle, last, monitor);
  }

  void split(std::size_t first, std::size_t middle, std::size_t last, bool by_x) {
    auto at = [this](std::size_t i) { return sites_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(middle), at(last), [by_x](const Site& p, const Site& q) {
      const Coordinate a = by_x ? p.x : p.y;
      const Coordinate b = by_x ? q.x : q.y;
      return a != b ? a < b : p.label < q.label;
    });
  }

  // A subtree can better the best if it may be nearer, or as near with a smaller label.
  bool worthwhile(std::size_t node, Distance d2, const Nearest& best) const {
    return d2 < best.d2 || (d2 == best.d2 && boxes_[node].least_label < best.label);
  }

  void search(std::size_t node, std::size_t first, std::size_t last, const Query& query,
              Nearest& best) const {
    if (node >= first_leaf_) {
      scan_leaf(first, last, query, best);
      return;
    }
    const std::size_t middle = std::midpoint(first, last);
    const std::size_t left = 2 * node + 1;
    const std::size_t right = left + 1;
    const Distance left_d2 = box_distance2(boxes_[left], query.x, query.y);
    const Distance right_d2 = box_distance2(boxes_[right], query.x, query.y);
    const bool left_first =
        left_d2 != right_d2 ? left_d2 < right_d2 : boxes_[left].least_label <= boxes_[right].least_label;
    if (left_first) {
      if (worthwhile(left, left_d2, best)) search(left, first, middle, query, best);
      if (worthwhile(right, right_d2, best)) search(right, middle, last, query, best);
    } else {
      if (worthwhile(right, right_d2, best)) search(right, middle, last, query, best);
      if (worthwhile(left, left_d2, best)) search(left, first, middle, query, best);
    }
  }

  void scan_leaf(std::size_t first, std::size_t last, const Query& query, Nearest& best) const {
    for (std::size_t i = first; i < last; ++i) {
      if (std::int64_t{sites_[i].index} == query.except) continue;
      const Distance d2 = distance2(sites_[i], query.x, query.y);
      const std::uint32_t label = sites_[i].label;
      if (d2 < best.d2 || (d2 == best.d2 && label < best.label)) {
        best = {d2, label, static_cast<std::ptrdiff_t>(i)};
      }
    }
  }

  std::vector<Site> sites_;
  std::vector<Box> boxes_;
  std::size_t first_leaf_;
};

}  // namespace vorotool::core::spatial
