// The facets of tetrahedra, each once, and their neighbors across.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"

namespace vorotool::core::tetrahedral_alpha {

using Row = std::array<std::int32_t, 4>;

// Facet 4 t + k is that opposite to corner k of tetrahedron t.
class Facets {
 public:
  // With the neighbors opposite to the corners, -1 outside; those that do not share the facet are refused. There is at
  // least one tetrahedron. One of the threads calls `beside` meanwhile.
  Facets(std::span<const Row> tetrahedra, std::span<const Row> neighbors, unsigned threads,
         const base::Monitor& monitor, const std::function<void()>& beside);

  // The same facet of the tetrahedron across: 4 u + l, or -1.
  std::int32_t across(std::int32_t facet) const {
    const auto t = static_cast<std::size_t>(facet) / 4, k = static_cast<std::size_t>(facet) % 4;
    const std::int32_t u = neighbors_[t][k];
    return u < 0 ? -1 : 4 * u + (places_[t] >> 2 * k & 3);
  }

  // Each once, in increasing order: of two tetrahedra that of the later one.
  base::LargeArray<std::int32_t> find(unsigned threads, const base::Monitor& monitor) const;

 private:
  // Of the tetrahedra begin ... end - 1; gives how many facets are counted as theirs.
  std::size_t find_places(std::span<const Row> tetrahedra, std::size_t begin, std::size_t end);

  std::size_t is_counted(std::size_t facet) const {
    return static_cast<std::size_t>(neighbors_[facet / 4][facet % 4] < static_cast<std::int32_t>(facet / 4));
  }

  std::span<const Row> neighbors_;
  base::LargeArray<std::uint8_t> places_;  // [t] two bits for each facet
  std::vector<std::size_t> start_;         // [pieces] of those found
};

}  // namespace vorotool::core::tetrahedral_alpha
