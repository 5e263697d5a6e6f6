// A tree of boxes over points and segments: the nearest to a place, those that meet a box, and what another
// tree needs to be compared with it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/distances/element.hpp"

namespace vorotool::core::distances {

struct Box {
  kernel::Point low, high;

  static Box of(const Element& e) {
    return {{std::min(e.a.x, e.b.x), std::min(e.a.y, e.b.y)},
            {std::max(e.a.x, e.b.x), std::max(e.a.y, e.b.y)}};
  }
  void add(const Box& box) {
    low = {std::min(low.x, box.low.x), std::min(low.y, box.low.y)};
    high = {std::max(high.x, box.high.x), std::max(high.y, box.high.y)};
  }
  bool meets(const Box& box) const {
    return low.x <= box.high.x && box.low.x <= high.x && low.y <= box.high.y && box.low.y <= high.y;
  }
  double square_distance(const Box& box) const {
    const double x = std::max({low.x - box.high.x, box.low.x - high.x, 0.0});
    const double y = std::max({low.y - box.high.y, box.low.y - high.y, 0.0});
    return x * x + y * y;
  }
};

// The nearest element to a place: the smallest square of the distance, then the smallest number.
struct Nearest {
  double d2 = std::numeric_limits<double>::infinity();
  std::uint32_t element = UINT32_MAX;  // none

  friend bool operator<(const Nearest& m, const Nearest& n) {
    return m.d2 < n.d2 || (m.d2 == n.d2 && m.element < n.element);
  }
};

class ElementTree {
 public:
  struct Item {
    Element element;
    std::uint32_t number;  // in the input
  };
  // Node k has the children 2k + 1 and 2k + 2, which halve its run of items.
  struct Node {
    Box box;
    std::uint32_t least_number;
  };
  struct Run {
    std::size_t node, first, last;

    Run left() const { return {2 * node + 1, first, std::midpoint(first, last)}; }
    Run right() const { return {2 * node + 2, std::midpoint(first, last), last}; }
    std::size_t size() const { return last - first; }
  };

  // At most 2^32 - 1 elements.
  ElementTree(std::span<const Element> elements, const base::Monitor& monitor);

  bool empty() const { return items_.empty(); }
  Run root() const { return {0, 0, items_.size()}; }
  bool is_leaf(const Run& run) const { return run.node >= first_leaf_; }
  const Node& node(const Run& run) const { return nodes_[run.node]; }
  std::span<const Item> items(const Run& run) const {
    return std::span(items_).subspan(run.first, run.size());
  }

  // The nearest of all elements and `best`, which is a good start where it is likely to be near.
  Nearest nearest(const kernel::Point& p, Nearest best = {}) const {
    if (!empty()) nearest(root(), Box{p, p}, best);
    return best;
  }

  // Calls visit(item) for every element whose box meets the given one.
  template <class Visit>
  void meeting(const Box& box, const Visit& visit) const {
    if (!empty()) meeting(root(), box, visit);
  }

 private:
  static constexpr std::size_t leaf_size = 4;

  void build(const Run& run, const base::Monitor& monitor);
  void nearest(const Run& run, const Box& place, Nearest& best) const;

  template <class Visit>
  void meeting(const Run& run, const Box& box, const Visit& visit) const {
    if (!node(run).box.meets(box)) return;
    if (is_leaf(run)) {
      for (const Item& item : items(run)) {
        if (Box::of(item.element).meets(box)) visit(item);
      }
      return;
    }
    meeting(run.left(), box, visit);
    meeting(run.right(), box, visit);
  }

  std::vector<Item> items_;
  std::vector<Node> nodes_;
  std::size_t first_leaf_ = 0;
};

}  // namespace vorotool::core::distances
