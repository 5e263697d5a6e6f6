#include "core/graphs/connected_components.hpp"

#include "core/base/disjoint_sets.hpp"

namespace vorotool::core::graphs {

std::vector<std::int32_t> connected_components(std::span<const base::IndexPair> edges, std::size_t vertices) {
  base::DisjointSets<std::int32_t> sets(vertices);
  for (const auto& [a, b] : edges) sets.join(a, b);
  std::vector<std::int32_t> root(vertices);
  for (std::size_t v = 0; v < vertices; ++v) root[v] = sets.find(static_cast<std::int32_t>(v));
  return root;
}

}  // namespace vorotool::core::graphs
