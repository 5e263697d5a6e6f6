#include "core/graphs/planar_map.hpp"

#include <algorithm>
#include <utility>

#include "core/base/groups.hpp"

namespace vorotool::core::graphs {

using base::at;
using base::IndexPair;

std::vector<std::int32_t> arcs_by_ends(std::span<const IndexPair> arcs, std::size_t vertices) {
  using Leaving = std::pair<std::int32_t, std::int32_t>;  // target and number
  base::Groups<Leaving> leaving(vertices, [&](const auto& add) {
    for (std::size_t k = 0; k < arcs.size(); ++k)
      add(arcs[k][0], Leaving{arcs[k][1], static_cast<std::int32_t>(k)});
  });
  std::vector<std::int32_t> sorted;
  sorted.reserve(arcs.size());
  for (std::size_t v = 0; v < vertices; ++v) {
    std::ranges::sort(leaving[v]);
    for (const auto& [target, number] : leaving[v]) sorted.push_back(number);
  }
  return sorted;
}

std::vector<std::int32_t> next_half_edges(std::span<const IndexPair> arcs,
                                          std::span<const std::int64_t> order, std::size_t vertices) {
  using Leaving = std::pair<std::int64_t, std::int32_t>;  // order and number
  base::Groups<Leaving> leaving(vertices, [&](const auto& add) {
    for (std::size_t h = 0; h < order.size(); ++h) {
      add(arcs[h / 2][h % 2], Leaving{order[h], static_cast<std::int32_t>(h)});
    }
  });
  std::vector<std::int32_t> next(order.size());
  for (std::size_t v = 0; v < vertices; ++v) {
    const std::span<Leaving> around = leaving[v];
    std::ranges::sort(around);
    // what arrives goes on with what is next clockwise after its own way back
    for (std::size_t k = 0; k < around.size(); ++k) {
      next[at(around[k].second ^ 1)] = around[k == 0 ? around.size() - 1 : k - 1].second;
    }
  }
  return next;
}

}  // namespace vorotool::core::graphs
