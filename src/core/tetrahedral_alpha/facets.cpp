#include "core/tetrahedral_alpha/facets.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <stdexcept>

#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"

namespace vorotool::core::tetrahedral_alpha {

using base::at;

namespace {

constexpr std::size_t tetrahedra_a_piece = std::size_t{1} << 14;
constexpr std::size_t ahead = 12;  // tetrahedra whose neighbors are loaded before their turn

// Four numbers, compared together: a lane is -1 where it is true.
typedef std::int32_t Lanes __attribute__((vector_size(16)));

Lanes is_any(const Lanes& v, const Row& row) {
  return (v == row[0]) | (v == row[1]) | (v == row[2]) | (v == row[3]);
}

}  // namespace

Facets::Facets(std::span<const Row> tetrahedra, std::span<const Row> neighbors, unsigned threads,
               const base::Monitor& monitor, const std::function<void()>& beside)
    : neighbors_(neighbors),
      places_(tetrahedra.size()),
      start_(base::piece_count(tetrahedra.size(), tetrahedra_a_piece) + 1) {
  constexpr std::size_t turn =
      1;  // of `beside`: the first piece is that of the thread that serves the monitor
  const auto run = [&](std::size_t index) {
    if (index == turn) return beside();
    const std::size_t piece = index < turn ? index : index - 1, begin = piece * tetrahedra_a_piece;
    start_[piece + 1] =
        find_places(tetrahedra, begin, std::min(tetrahedra.size(), begin + tetrahedra_a_piece));
  };
  base::parallel_for(start_.size(), threads, run, monitor);
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
}

std::size_t Facets::find_places(std::span<const Row> tetrahedra, std::size_t begin, std::size_t end) {
  static constexpr Lanes others[4] = {{0, -1, -1, -1}, {-1, 0, -1, -1}, {-1, -1, 0, -1}, {-1, -1, -1, 0}};
  Lanes wrong{};
  std::size_t count = 0;
  for (std::size_t t = begin; t < end; ++t) {
    for (const std::int32_t u : neighbors_[std::min(t + ahead, end - 1)]) {
      const std::size_t next = u < 0 ? t : at(u);
      __builtin_prefetch(&tetrahedra[next]);
      __builtin_prefetch(&neighbors_[next]);
    }
    const Lanes corners = std::bit_cast<Lanes>(tetrahedra[t]);
    unsigned places = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::int32_t u = neighbors_[t][k];
      count += is_counted(4 * t + k);
      if (u < 0) continue;
      const Row& back = neighbors_[at(u)];
      const auto is_back = [&](std::size_t l) {
        return static_cast<unsigned>(back[l] == static_cast<std::int32_t>(t));
      };
      const unsigned place = (is_back(1) + 2 * is_back(2) + 3 * is_back(3)) & 3U;
      wrong |= others[k] & ~is_any(corners, tetrahedra[at(u)]);
      wrong[0] |= static_cast<std::int32_t>(is_back(place)) - 1;
      places |= place << 2 * k;
    }
    places_[t] = static_cast<std::uint8_t>(places);
  }
  if ((wrong[0] | wrong[1] | wrong[2] | wrong[3]) != 0)
    throw std::invalid_argument("a neighbor does not share the facet");
  return count;
}

base::LargeArray<std::int32_t> Facets::find(unsigned threads, const base::Monitor& monitor) const {
  base::LargeArray<std::int32_t> facets(start_.back());
  base::for_pieces(neighbors_.size(), tetrahedra_a_piece, threads, monitor,
                   [&](std::size_t piece, std::size_t begin, std::size_t end) {
                     std::size_t next = start_[piece];
                     for (std::size_t facet = 4 * begin; facet < 4 * end && next < start_[piece + 1];
                          ++facet) {
                       facets[next] = static_cast<std::int32_t>(facet);
                       next += is_counted(facet);
                     }
                   });
  return facets;
}

}  // namespace vorotool::core::tetrahedral_alpha
