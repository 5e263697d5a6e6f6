#include "core/voronoi/border_nodes.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/voronoi/ring_ranks.hpp"

namespace vorotool::core::voronoi {

using base::at;
using base::no_index;
using segment_voronoi::build::DiagramView;

namespace {

constexpr std::size_t borders_a_piece = 1 << 15;

std::int64_t number_of(std::int64_t rank, bool is_wall) { return 2 * rank + (is_wall ? 0 : 1); }

}  // namespace

struct BorderNodes::End {
  std::size_t number;  // of the border twice, and 1 for its target
  std::int64_t node;
  std::int32_t left, right;  // as seen from the node

  bool is_wall() const { return left == right; }
};

BorderNodes::BorderNodes(const DiagramView& diagram, std::span<const std::uint8_t> is_needed)
    : diagram_(diagram), is_needed_(is_needed), of_point_(diagram.points.size(), no_index) {
  find_vertices_of_points();
  number_points();
}

// Where three of its elements meet at a point, there is a vertex of radius 0.
void BorderNodes::find_vertices_of_points() {
  for (std::size_t v = 0; v < diagram_.vertex_count(); ++v) {
    if (diagram_.radius[v] != 0) continue;
    const auto ring = diagram_.ring(v);
    if (ring.size() < 2) throw std::invalid_argument("fewer than two sites meet at a corner");
    const std::int32_t first = ring[0], second = ring[1];
    std::int32_t point = first;
    if (!diagram_.is_point(first)) {
      const auto [a, b] = diagram_.ends(first);
      point = !diagram_.is_point(second) && diagram_.is_end(a, second) ? a : b;
    }
    of_point_[at(point)] = static_cast<std::int32_t>(v);
  }
}

void BorderNodes::number_points() {
  for (std::size_t p = 0; p < is_needed_.size(); ++p) {
    if (is_needed_[p] != 0 && of_point_[p] == no_index) added_.push_back(static_cast<std::int32_t>(p));
  }
  std::ranges::sort(added_, {},
                    [&](std::int32_t p) { return std::pair(diagram_.point(p).x, diagram_.point(p).y); });
  auto number = static_cast<std::int32_t>(diagram_.vertex_count());
  for (const std::int32_t point : added_) of_point_[at(point)] = number++;
}

// The smallest segment at each of the points that were added.
std::vector<std::int32_t> BorderNodes::first_segments() const {
  const std::size_t vertices = diagram_.vertex_count();
  std::vector<std::int32_t> first(added_.size(), no_index);
  if (added_.empty()) return first;
  for (std::size_t j = 0; j < diagram_.segments.size(); ++j) {
    for (const std::int32_t point : diagram_.segments[j]) {
      const std::int32_t node = of_point_[at(point)];
      if (node == no_index || at(node) < vertices || first[at(node) - vertices] != no_index) continue;
      first[at(node) - vertices] = static_cast<std::int32_t>(diagram_.points.size() + j);
    }
  }
  return first;
}

// Around a point between two segments: the first one, what is left of it, the second one, what is right.
std::int64_t BorderNodes::order_in_line(const End& end, const std::vector<std::int32_t>& first) const {
  const std::int32_t segment = first[static_cast<std::size_t>(end.node) - diagram_.vertex_count()];
  if (end.is_wall()) return end.left == segment ? 0 : 2;
  // a half beside the first segment has that on its right where it is left of it
  const bool is_left = diagram_.is_point(end.right) ? end.left != segment : end.right == segment;
  return is_left ? 1 : 3;
}

void BorderNodes::put_in_order(std::span<const std::int64_t> ends, std::span<const std::int64_t> elements,
                               std::span<const std::int32_t> crowded, std::span<std::int64_t> order,
                               unsigned threads, const base::Monitor& monitor) const {
  const std::size_t vertices = diagram_.vertex_count(), borders = ends.size() / 2;
  std::vector<std::int32_t> degree(vertices + added_.size());
  for (const std::int64_t node : ends) {
    if (node >= 0) ++degree[static_cast<std::size_t>(node)];
  }
  for (const std::int32_t vertex : crowded) degree[at(vertex)] += 3;
  const std::vector<std::int32_t> first = first_segments();
  std::vector<std::vector<End>> many(base::piece_count(borders, borders_a_piece));
  base::for_pieces(borders, borders_a_piece, threads, monitor,
                   [&](std::size_t piece, std::size_t begin, std::size_t last) {
                     for (std::size_t k = 2 * begin; k < 2 * last; ++k) {
                       order[k] = 0;
                       const std::int64_t node = ends[k];
                       if (node < 0 || degree[static_cast<std::size_t>(node)] <= 2) continue;
                       const End end{k, node, static_cast<std::int32_t>(elements[k]),
                                     static_cast<std::int32_t>(elements[k ^ 1])};
                       if (static_cast<std::size_t>(node) >= vertices) {
                         order[k] = order_in_line(end, first);
                       } else if (diagram_.ring(static_cast<std::size_t>(node)).size() > few_sites) {
                         many[piece].push_back(end);
                       } else {
                         order[k] =
                             number_of(rank_of(diagram_.ring(static_cast<std::size_t>(node)), end.right),
                                       end.is_wall());
                       }
                     }
                   });
  for (const std::vector<End>& ends_of_piece : many) {
    std::vector<std::int64_t> nodes, rights;
    for (const End& end : ends_of_piece) {
      nodes.push_back(end.node);
      rights.push_back(end.right);
    }
    const std::vector<std::int64_t> ranks = ranks_around(diagram_, nodes, rights);
    for (std::size_t k = 0; k < ranks.size(); ++k) {
      order[ends_of_piece[k].number] = number_of(ranks[k], ends_of_piece[k].is_wall());
    }
  }
}

}  // namespace vorotool::core::voronoi
