#include "core/tetrahedral_alpha/edge_stars.hpp"

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "core/base/atomic_ref.hpp"

namespace vorotool::core::tetrahedral_alpha {

LargeArray<Edge> sort_edges(std::vector<std::vector<Edge>>&& found, std::size_t vertices, unsigned threads,
                            const base::Monitor& monitor) {
  constexpr std::size_t vertices_a_piece = std::size_t{1} << 13;
  std::vector<std::uint32_t> ends(vertices + 1);  // where the edges of each vertex with later ones end
  base::parallel_for(
      found.size(), threads,
      [&](std::size_t piece) {
        for (const Edge& edge : found[piece])
          base::atomic_ref(ends[at(edge.ends[0]) + 1]).fetch_add(1, std::memory_order_relaxed);
      },
      monitor);
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  LargeArray<Edge> edges(ends.back());
  base::parallel_for(
      found.size(), threads,
      [&](std::size_t piece) {
        for (const Edge& edge : found[piece])
          edges[base::atomic_ref(ends[at(edge.ends[0])]).fetch_add(1, std::memory_order_relaxed)] = edge;
        found[piece] = {};
      },
      monitor);
  base::for_items(vertices, vertices_a_piece, threads, monitor, [&](std::size_t v) {
    std::sort(edges.data() + (v == 0 ? 0 : ends[v - 1]), edges.data() + ends[v],
              [](const Edge& p, const Edge& q) {
                return std::tie(p.ends[1], p.star) < std::tie(q.ends[1], q.star);
              });
  });
  return edges;
}

void TetrahedronStars::refuse() { throw std::invalid_argument("a neighbor does not share the facet"); }

}  // namespace vorotool::core::tetrahedral_alpha
