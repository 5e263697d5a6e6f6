// Points and closed segments in a tree of oriented boxes: which of them are near a place?
//
// Boxes follow the longest segment that they hold, or the way in which its ends are spread, and long segments
// are told apart across their direction: so the thin bundles of spikes and combs do not overlap as boxes
// along the axes would.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/kernel/lattice.hpp"

namespace vorotool::core::spatial {

struct OrientedBox {
  double ux, uy;                            // about a unit vector
  double t_least, t_most, n_least, n_most;  // along it, and across
};

class ObbTree {
 public:
  ObbTree(std::span<const kernel::LatticeSite> items, unsigned threads, const base::Monitor& monitor);

  // Calls visit(item) for every item not farther than reach from (x, y), and for some others. It stops where
  // visit gives false.
  template <class Visit>
  void near(double x, double y, double reach, const Visit& visit) const {
    if (index_.empty()) return;
    const double wide = reach + error_at(x, y);
    near(levels_.size() - 1, 0, x, y, wide * wide * (1 + 0x1p-50), visit);
  }

  // The distance of (x, y) from the nearest item, less up to `slack` of it: of many that are about as near,
  // few are looked at. `distance(item)` gives that of one.
  template <class Distance>
  double nearest(double x, double y, double slack, const Distance& distance) const {
    double best = std::numeric_limits<double>::infinity();
    if (!index_.empty()) nearest(levels_.size() - 1, 0, x, y, 1 - slack, distance, best);
    return best * (1 - slack);
  }

 private:
  static constexpr std::size_t leaf_size = 4;

  // Of the distance of a box: t and n below have errors of at most 2^-51 (|x| + |y|), what bounds the boxes
  // has 2^-20.
  static double error_at(double x, double y) { return 0x1p-18 + 0x1p-49 * (std::abs(x) + std::abs(y)); }

  double square_distance(std::size_t level, std::size_t node, double x, double y) const {
    const OrientedBox& box = levels_[level][node];
    const double t = box.ux * x + box.uy * y, n = box.ux * y - box.uy * x;
    const double dt = std::max(std::max(box.t_least - t, t - box.t_most), 0.0);
    const double dn = std::max(std::max(box.n_least - n, n - box.n_most), 0.0);
    return dt * dt + dn * dn;
  }

  template <class Distance>
  void nearest(std::size_t level, std::size_t node, double x, double y, double share,
               const Distance& distance, double& best) const {
    if (level == 0) {
      const std::size_t last = std::min(index_.size(), (node + 1) * leaf_size);
      for (std::size_t i = node * leaf_size; i < last; ++i) best = std::min(best, distance(index_[i]));
      return;
    }
    std::array<std::pair<double, std::size_t>, 2> below{std::pair{0.0, 2 * node}, {0.0, 2 * node + 1}};
    const std::size_t count = below[1].second < levels_[level - 1].size() ? 2 : 1;
    for (std::size_t i = 0; i < count; ++i)
      below[i].first = std::sqrt(square_distance(level - 1, below[i].second, x, y)) - error_at(x, y);
    if (count == 2 && below[1].first < below[0].first) std::swap(below[0], below[1]);
    for (std::size_t i = 0; i < count; ++i) {
      if (below[i].first < share * best) nearest(level - 1, below[i].second, x, y, share, distance, best);
    }
  }

  template <class Visit>
  bool near(std::size_t level, std::size_t node, double x, double y, double reach2,
            const Visit& visit) const {
    if (square_distance(level, node, x, y) > reach2) return true;
    if (level == 0) {
      const std::size_t last = std::min(index_.size(), (node + 1) * leaf_size);
      for (std::size_t i = node * leaf_size; i < last; ++i) {
        if (!visit(index_[i])) return false;
      }
      return true;
    }
    if (!near(level - 1, 2 * node, x, y, reach2, visit)) return false;
    return 2 * node + 1 >= levels_[level - 1].size() || near(level - 1, 2 * node + 1, x, y, reach2, visit);
  }

  std::vector<std::uint32_t> index_;  // of the items, in the order of the leaves
  // The leaves first; node i holds nodes 2 i and 2 i + 1 of the level below, which holds the first half of
  // what node i has room for, and the rest.
  std::vector<std::vector<OrientedBox>> levels_;
};

}  // namespace vorotool::core::spatial
