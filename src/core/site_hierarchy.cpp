#include "core/site_hierarchy.hpp"

#include <limits>

#include "core/parallel.hpp"
#include "core/point_order.hpp"

namespace vorotool::core {
namespace {

double length(const LatticeSite& site) {
  return std::hypot(static_cast<double>(site.b.x) - site.a.x, static_cast<double>(site.b.y) - site.a.y);
}

}  // namespace

SiteHierarchy::SiteHierarchy(std::span<const LatticeSite> items, unsigned threads, const Monitor& monitor) {
  std::vector<Point> middles;
  middles.reserve(items.size());
  for (const LatticeSite& s : items) {
    middles.push_back(
        {0.5 * (static_cast<double>(s.a.x) + s.b.x), 0.5 * (static_cast<double>(s.a.y) + s.b.y)});
  }
  std::vector<std::int32_t> first(items.size());
  index_ = morton_order(middles, first, threads, monitor).index;
  items_.reserve(items.size());
  for (const std::uint32_t i : index_) items_.push_back(items[i]);
  if (items_.empty()) return;

  std::vector<std::size_t> longest;  // of each node
  for (std::size_t size = leaf_size, nodes = 2; nodes > 1; size *= 2) {
    nodes = piece_count(items_.size(), size);
    std::vector<std::size_t> chosen(nodes);
    std::vector<Box> boxes(nodes);
    constexpr std::size_t grain = 1 << 14;
    const std::size_t nodes_a_piece = std::max<std::size_t>(1, grain / size);
    parallel_for(
        piece_count(nodes, nodes_a_piece), threads,
        [&](std::size_t piece) {
          const std::size_t end = std::min(nodes, (piece + 1) * nodes_a_piece);
          for (std::size_t node = piece * nodes_a_piece; node < end; ++node) {
            const std::size_t from = node * size, to = std::min(items_.size(), from + size);
            chosen[node] = from;
            if (size == leaf_size) {
              for (std::size_t i = from + 1; i < to; ++i) {
                if (length(items_[i]) > length(items_[chosen[node]])) chosen[node] = i;
              }
            } else {
              chosen[node] = longest[2 * node];
              const std::size_t other = 2 * node + 1 < longest.size() ? longest[2 * node + 1] : chosen[node];
              if (length(items_[other]) > length(items_[chosen[node]])) chosen[node] = other;
            }
            boxes[node] = box_around(from, to, chosen[node]);
          }
        },
        monitor);
    longest = std::move(chosen);
    levels_.push_back(std::move(boxes));
  }
}

SiteHierarchy::Box SiteHierarchy::box_around(std::size_t first, std::size_t last, std::size_t longest) const {
  const LatticeSite& along = items_[longest];
  const double size = length(along);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box box{1, 0, infinity, -infinity, infinity, -infinity};
  if (size > 0) {
    box.ux = (static_cast<double>(along.b.x) - along.a.x) / size;
    box.uy = (static_cast<double>(along.b.y) - along.a.y) / size;
  }
  for (std::size_t i = first; i < last; ++i) {
    for (const LatticePoint& p : {items_[i].a, items_[i].b}) {
      const double t = box.ux * p.x + box.uy * p.y, n = box.ux * p.y - box.uy * p.x;
      box.t_least = std::min(box.t_least, t);
      box.t_most = std::max(box.t_most, t);
      box.n_least = std::min(box.n_least, n);
      box.n_most = std::max(box.n_most, n);
    }
  }
  return box;
}

}  // namespace vorotool::core
