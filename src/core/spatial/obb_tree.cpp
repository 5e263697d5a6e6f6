#include "core/spatial/obb_tree.hpp"

#include <numeric>

#include "core/base/parallel.hpp"

namespace vorotool::core::spatial {

using kernel::LatticeSite;

namespace {

struct Way {
  double x, y;
};

Way way_of(const LatticeSite& site) {
  return {static_cast<double>(site.b.x) - site.a.x, static_cast<double>(site.b.y) - site.a.y};
}

double length(const Way& way) { return std::sqrt(way.x * way.x + way.y * way.y); }
double area(const OrientedBox& box) { return (box.t_most - box.t_least) * (box.n_most - box.n_least); }

// A run of items: those whose numbers are in a part of the index.
class Bundle {
 public:
  Bundle(std::span<const LatticeSite> items, std::span<std::uint32_t> numbers)
      : items_(items), numbers_(numbers) {
    for (const std::uint32_t i : numbers) {
      const Way way = way_of(items[i]);
      if (length(way) > length(longest_)) longest_ = way;
    }
  }

  OrientedBox box() const {
    const OrientedBox along_longest = box_along(longest_), along_axis = box_along(principal_axis());
    return area(along_axis) < area(along_longest) ? along_axis : along_longest;
  }

  // Brings the items that come first along the box, or across it where they are long, to the front.
  void split(const OrientedBox& box, std::size_t first_count) {
    const double along = box.t_most - box.t_least, across = box.n_most - box.n_least;
    const bool by_n = 2 * length(longest_) > along || across > along;
    auto place = [&](std::uint32_t i) {
      const LatticeSite& s = items_[i];
      const double x = static_cast<double>(s.a.x) + s.b.x, y = static_cast<double>(s.a.y) + s.b.y;
      return by_n ? box.ux * y - box.uy * x : box.ux * x + box.uy * y;
    };
    std::nth_element(numbers_.begin(), numbers_.begin() + static_cast<std::ptrdiff_t>(first_count),
                     numbers_.end(), [&](std::uint32_t i, std::uint32_t j) { return place(i) < place(j); });
  }

 private:
  // Where the ends are spread most: an eigenvector of their covariance.
  Way principal_axis() const {
    const double count = 2 * static_cast<double>(numbers_.size());
    double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    for (const std::uint32_t i : numbers_) {
      x += (static_cast<double>(items_[i].a.x) + items_[i].b.x) / count;
      y += (static_cast<double>(items_[i].a.y) + items_[i].b.y) / count;
    }
    for (const std::uint32_t i : numbers_) {
      for (const kernel::LatticePoint& p : {items_[i].a, items_[i].b}) {
        xx += (p.x - x) * (p.x - x);
        xy += (p.x - x) * (p.y - y);
        yy += (p.y - y) * (p.y - y);
      }
    }
    const double half = 0.5 * (xx - yy), root = std::sqrt(half * half + xy * xy);
    return half > 0 ? Way{half + root, xy} : Way{xy, root - half};
  }

  OrientedBox box_along(const Way& way) const {
    const double size = length(way);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    OrientedBox box{1, 0, infinity, -infinity, infinity, -infinity};
    if (size > 0) {
      box.ux = way.x / size;
      box.uy = way.y / size;
    }
    for (const std::uint32_t i : numbers_) {
      for (const kernel::LatticePoint& p : {items_[i].a, items_[i].b}) {
        const double t = box.ux * p.x + box.uy * p.y, n = box.ux * p.y - box.uy * p.x;
        box.t_least = std::min(box.t_least, t);
        box.t_most = std::max(box.t_most, t);
        box.n_least = std::min(box.n_least, n);
        box.n_most = std::max(box.n_most, n);
      }
    }
    return box;
  }

  std::span<const LatticeSite> items_;
  std::span<std::uint32_t> numbers_;
  Way longest_{0, 0};
};

}  // namespace

ObbTree::ObbTree(std::span<const LatticeSite> items, unsigned threads, const base::Monitor& monitor)
    : index_(items.size()) {
  std::iota(index_.begin(), index_.end(), 0U);
  std::size_t levels = 1;
  while (leaf_size << (levels - 1) < items.size()) ++levels;
  levels_.resize(items.empty() ? 0 : levels);
  for (std::size_t level = levels_.size(); level-- > 0;) {
    const std::size_t size = leaf_size << level, nodes = base::piece_count(items.size(), size);
    levels_[level].resize(nodes);
    constexpr std::size_t grain = 1 << 14;  // items of a piece
    const std::size_t a_piece = std::max<std::size_t>(1, grain / size);
    base::for_items(nodes, a_piece, threads, monitor, [&](std::size_t node) {
      const std::size_t from = node * size, count = std::min(size, items.size() - from);
      Bundle bundle(items, std::span(index_).subspan(from, count));
      levels_[level][node] = bundle.box();
      if (level > 0 && count > size / 2) bundle.split(levels_[level][node], size / 2);
    });
  }
}

}  // namespace vorotool::core::spatial
