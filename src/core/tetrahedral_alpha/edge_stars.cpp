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

TetrahedronStars::TetrahedronStars(std::span<const Row> tetrahedra, std::span<const Row> neighbors,
                                   unsigned threads, const base::Monitor& monitor)
    : tetrahedra_(tetrahedra), neighbors_(neighbors), places_(4 * tetrahedra.size()) {
  std::fill_n(places_.data(), places_.size(),
              std::uint8_t{0});  // where nothing is matched two corners have one place
  base::for_items(tetrahedra.size(), std::size_t{1} << 14, threads, monitor,
                  [this](std::size_t t) { match_facets(t); });
}

// For both sides of the facets at which a tetrahedron has a neighbor that comes before it.
void TetrahedronStars::match_facets(std::size_t t) {
  const auto position = [](const Row& row, std::int32_t value) {
    return static_cast<std::size_t>((row[1] == value) + 2 * (row[2] == value) + 3 * (row[3] == value)) & 3;
  };
  for (std::size_t k = 0; k < 4; ++k) {
    const std::int32_t u = neighbors_[t][k];
    if (u < 0 || at(u) >= t) continue;
    const std::size_t back = position(neighbors_[at(u)], static_cast<std::int32_t>(t));
    unsigned here = 0, there = 0;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const std::size_t place = corner == k ? back : position(tetrahedra_[at(u)], tetrahedra_[t][corner]);
      here |= static_cast<unsigned>(place << 2 * corner);
      there |= static_cast<unsigned>(corner << 2 * place);
      if (corner != k && tetrahedra_[at(u)][place] != tetrahedra_[t][corner]) refuse();
    }
    if (neighbors_[at(u)][back] != static_cast<std::int32_t>(t)) refuse();
    places_[4 * t + k] = static_cast<std::uint8_t>(here);
    places_[4 * at(u) + back] = static_cast<std::uint8_t>(there);
  }
}

void TetrahedronStars::refuse() { throw std::invalid_argument("a neighbor does not share the facet"); }

}  // namespace vorotool::core::tetrahedral_alpha
