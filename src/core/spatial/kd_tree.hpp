// A k-d tree over labelled points of the plane or of space that answers "which label is nearest" exactly, ties to
// the smallest label.
#pragma once

#include <algorithm>
#include <array>
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
// - std::int64_t, std::uint64_t: exact while coordinates differ by at most 2^31: 3 * (2^31)^2 < 2^64;
// - std::int64_t, uint128: exact while coordinates are at most 2^62: 3 * (2^63)^2 < 2^128;
// - double, double: the minimum of squared distances as they are rounded, exact where they need at most 53
//   bits. The search adds no error of its own: rounding is monotonic, so the rounded distance to a box never
//   exceeds that to a point in it.
template <class Coordinate, class Distance, std::size_t Axes = 2>
class KdTree {
 public:
  using Place = std::array<Coordinate, Axes>;
  using Columns = std::array<std::span<const Coordinate>, Axes>;

  struct Site {
    Place at;
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
  KdTree(const Columns& columns, std::span<const std::uint32_t> labels, const base::Monitor& monitor) {
    sites_.resize(labels.size());
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      for (std::size_t axis = 0; axis < Axes; ++axis) sites_[i].at[axis] = columns[axis][i];
      sites_[i].label = labels[i];
      sites_[i].index = static_cast<std::uint32_t>(i);
    }
    std::size_t leaves = 1;
    while (leaves * leaf_size < sites_.size()) leaves *= 2;
    boxes_.resize(2 * leaves - 1);
    first_leaf_ = leaves - 1;
    if (!sites_.empty()) build(0, 0, sites_.size(), monitor);
  }

  std::size_t size() const { return sites_.size(); }
  const Site& site(std::ptrdiff_t place) const { return sites_[static_cast<std::size_t>(place)]; }

  static Distance distance2(const Site& site, const Place& at) {
    Distance sum = square(gap(site.at[0], at[0]));
    for (std::size_t axis = 1; axis < Axes; ++axis) sum += square(gap(site.at[axis], at[axis]));
    return sum;
  }

  // The start of a query from a site that is likely to be near: a good bound from the beginning.
  Nearest bound(std::ptrdiff_t place, const Place& at) const {
    return {distance2(site(place), at), site(place).label, place};
  }

  // Lexicographic minimum of (d2, label) over all sites but the one with index `except`, and `best`.
  Nearest nearest(const Place& at, Nearest best = {}, std::int64_t except = -1) const {
    if (!sites_.empty()) search(0, 0, sites_.size(), {at, except}, best);
    return best;
  }

 private:
  static constexpr std::size_t leaf_size = 8;  // sites a leaf at most

  // Node k has the children 2k + 1 and 2k + 2, which halve its range of sites.
  struct Box {
    Place low, high;
    std::uint32_t least_label;
  };
  struct Query {
    Place at;
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

  static Distance box_distance2(const Box& box, const Place& at) {
    const auto along = [&](std::size_t axis) {
      return square(gap(at[axis], std::clamp(at[axis], box.low[axis], box.high[axis])));
    };
    Distance sum = along(0);
    for (std::size_t axis = 1; axis < Axes; ++axis) sum += along(axis);
    return sum;
  }

  void build(std::size_t node, std::size_t first, std::size_t last, const base::Monitor& monitor) {
    if (last - first > 4096) base::report(monitor, 0);
    Box box{sites_[first].at, sites_[first].at, UINT32_MAX};
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t axis = 0; axis < Axes; ++axis) {
        box.low[axis] = std::min(box.low[axis], sites_[i].at[axis]);
        box.high[axis] = std::max(box.high[axis], sites_[i].at[axis]);
      }
      box.least_label = std::min(box.least_label, sites_[i].label);
    }
    boxes_[node] = box;
    if (node >= first_leaf_) return;
    const std::size_t middle = std::midpoint(first, last);
    split(first, middle, last, widest_axis(box));
    build(2 * node + 1, first, middle, monitor);
    build(2 * node + 2, middle, last, monitor);
  }

  static std::size_t widest_axis(const Box& box) {
    std::size_t widest = 0;
    for (std::size_t axis = 1; axis < Axes; ++axis) {
      if (gap(box.low[axis], box.high[axis]) > gap(box.low[widest], box.high[widest])) widest = axis;
    }
    return widest;
  }

  void split(std::size_t first, std::size_t middle, std::size_t last, std::size_t axis) {
    auto at = [this](std::size_t i) { return sites_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(middle), at(last), [axis](const Site& p, const Site& q) {
      return p.at[axis] != q.at[axis] ? p.at[axis] < q.at[axis] : p.label < q.label;
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
    const Distance left_d2 = box_distance2(boxes_[left], query.at);
    const Distance right_d2 = box_distance2(boxes_[right], query.at);
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
      const Distance d2 = distance2(sites_[i], query.at);
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
