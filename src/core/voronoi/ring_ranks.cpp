#include "core/voronoi/ring_ranks.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace vorotool::core::voronoi {

using segment_voronoi::build::DiagramView;

namespace {

using Ranks = std::vector<std::pair<std::int32_t, std::int64_t>>;  // by site

[[noreturn]] void fail() {
  throw std::runtime_error("a border ends at a vertex that its element does not touch");
}

Ranks sorted_ranks(std::span<const std::int32_t> ring) {
  Ranks ranks;
  for (std::size_t k = 0; k < ring.size(); ++k) ranks.emplace_back(ring[k], static_cast<std::int64_t>(k));
  std::ranges::sort(ranks);
  return ranks;
}

}  // namespace

std::int64_t rank_of(std::span<const std::int32_t> ring, std::int32_t site) {
  const auto found = std::ranges::find(ring, site);
  if (found == ring.end()) fail();
  return found - ring.begin();
}

std::vector<std::int64_t> ranks_around(const DiagramView& diagram, std::span<const std::int64_t> vertex,
                                       std::span<const std::int64_t> site) {
  std::vector<std::int64_t> ranks(vertex.size());
  std::vector<std::pair<std::int64_t, std::size_t>> many;  // by vertex
  for (std::size_t k = 0; k < vertex.size(); ++k) {
    const auto ring = diagram.ring(static_cast<std::size_t>(vertex[k]));
    if (ring.size() > few_sites) {
      many.emplace_back(vertex[k], k);
    } else {
      ranks[k] = rank_of(ring, static_cast<std::int32_t>(site[k]));
    }
  }
  std::ranges::sort(many);
  Ranks known;
  for (std::size_t i = 0; i < many.size(); ++i) {
    const auto [v, k] = many[i];
    if (i == 0 || many[i - 1].first != v) known = sorted_ranks(diagram.ring(static_cast<std::size_t>(v)));
    const auto wanted = static_cast<std::int32_t>(site[k]);
    const auto found = std::ranges::lower_bound(known, wanted, {}, &Ranks::value_type::first);
    if (found == known.end() || found->first != wanted) fail();
    ranks[k] = found->second;
  }
  return ranks;
}

}  // namespace vorotool::core::voronoi
