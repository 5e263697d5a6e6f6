// The edges of tetrahedra or triangles, each with the cells around it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/base/parallel.hpp"

namespace vorotool::core::tetrahedral_alpha {

using base::at;
using base::LargeArray;

struct Edge {
  std::array<std::int32_t, 2> ends;  // the smaller one first
  std::uint32_t star;                // where its cells begin
  std::uint32_t is_cut = 0;
};

// Puts edges, found in pieces, in the order of their ends and then their stars.
LargeArray<Edge> sort_edges(std::vector<std::vector<Edge>>&& found, std::size_t vertices, unsigned threads,
                            const base::Monitor& monitor);

// Of tetrahedra (width 4), which follow each other around an edge through the facets at it.
class TetrahedronStars {
 public:
  using Row = std::array<std::int32_t, 4>;

  // With the neighbors opposite to the corners, -1 outside.
  TetrahedronStars(std::span<const Row> tetrahedra, std::span<const Row> neighbors, unsigned threads,
                   const base::Monitor& monitor);

  // The same facet of the tetrahedron across facet 4 t + k: 4 u + l, or -1.
  std::int32_t across(std::size_t facet) const {
    const std::int32_t u = neighbors_[facet / 4][facet % 4];
    return u < 0 ? -1 : 4 * u + static_cast<std::int32_t>(place_across(facet, facet % 4));
  }

  // Calls visit(t, out, apex) for all facets at an edge, each once: that opposite to corner `out` of a tetrahedron t
  // around it, whose corner off the edge is `apex`. So it is called for all tetrahedra around it. Gives false as soon as
  // a visit does.
  template <class Visit>
  bool visit(const Edge& edge, const Visit& visit) const {
    const auto [k, l] = corners[5 - edge.star % 8];
    const End end = turn(edge.star / 8, k, l, visit);
    return end == End::outside ? turn(edge.star / 8, l, k, visit) != End::stopped : end == End::closed;
  }

  // The edges, cut where is_cut(edge, t, out, apex) holds for a facet. An edge belongs to the piece of its first
  // tetrahedron.
  template <class IsCut>
  LargeArray<Edge> find(std::size_t vertices, const IsCut& is_cut, unsigned threads,
                        const base::Monitor& monitor) const {
    std::vector<std::vector<Edge>> found(base::piece_count(tetrahedra_.size(), tetrahedra_a_piece));
    base::for_pieces(tetrahedra_.size(), tetrahedra_a_piece, threads, monitor,
                     [&](std::size_t piece, std::size_t begin, std::size_t end) {
                       std::vector<std::uint8_t> seen(end - begin);  // sides of each tetrahedron
                       found[piece].reserve(end - begin + (end - begin) / 4);
                       for (std::size_t t = begin; t < end; ++t) {
                         for (unsigned left = ~unsigned{seen[t - begin]} & 63; left != 0; left &= left - 1) {
                           Edge edge = edge_of(t, static_cast<std::size_t>(std::countr_zero(left)));
                           if (is_first(edge, begin, seen, is_cut)) found[piece].push_back(edge);
                         }
                       }
                     });
    return sort_edges(std::move(found), vertices, threads, monitor);
  }

 private:
  enum class End { closed, outside, stopped };

  static constexpr std::size_t tetrahedra_a_piece = std::size_t{1} << 17;  // some 50 ms

  // The sides of a tetrahedron; that opposite to each has 5 less its number.
  static constexpr std::array<std::array<std::uint8_t, 2>, 6> corners{
      {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
  static constexpr std::array<std::array<std::uint8_t, 4>, 4> opposite_side{
      {{6, 5, 4, 3}, {5, 6, 2, 1}, {4, 2, 6, 0}, {3, 1, 0, 6}}};

  Edge edge_of(std::size_t t, std::size_t side) const {
    const std::int32_t a = tetrahedra_[t][corners[side][0]], b = tetrahedra_[t][corners[side][1]];
    return {{std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(8 * t + side)};
  }

  // Whether no tetrahedron around an edge comes before a piece; then it is known whether it is cut.
  template <class IsCut>
  bool is_first(Edge& edge, std::size_t begin, std::vector<std::uint8_t>& seen, const IsCut& is_cut) const {
    return visit(edge, [&](std::size_t t, std::size_t out, std::size_t apex) {
      if (t < begin) return false;
      if (t - begin < seen.size())
        seen[t - begin] |= static_cast<std::uint8_t>(1U << opposite_side[out][apex]);
      edge.is_cut |= std::uint32_t{is_cut(edge, t, out, apex)};
      return true;
    });
  }

  // Where the neighbor across a facet has a corner of it, and for the opposite corner its own.
  std::size_t place_across(std::size_t facet, std::size_t corner) const {
    return places_[facet] >> 2 * corner & 3U;
  }

  template <class Visit>
  End turn(std::size_t first, std::size_t out, std::size_t apex, const Visit& visit) const {
    std::size_t t = first;
    for (std::size_t steps = 0;; ++steps) {
      if (!visit(t, out, apex)) return End::stopped;
      const std::int32_t next = neighbors_[t][out];
      if (next < 0) return End::outside;
      if (at(next) == first) return End::closed;
      const std::size_t facet = 4 * t + out, from = place_across(facet, out);
      t = at(next);
      out = place_across(facet, apex);
      apex = from;
      if (out == apex || steps > tetrahedra_.size()) refuse();
    }
  }

  void match_facets(std::size_t t);
  [[noreturn]] static void refuse();

  std::span<const Row> tetrahedra_, neighbors_;
  LargeArray<std::uint8_t> places_;  // [4 t + k] two bits for each corner
};

// Of triangles (width 3), or edges that are the cells themselves (2).
template <std::size_t width>
class PlanarStars {
 public:
  using Cell = std::array<std::int32_t, width>;

  explicit PlanarStars(std::span<const Cell> cells) : cells_(cells) {}

  // Calls visit(t) for the cells around an edge.
  template <class Visit>
  void visit(const Edge& edge, const Visit& visit) const {
    for (std::size_t i = edge.star; i < sides_.size() && sides_[i].ends == edge.ends; ++i)
      visit(std::size_t{sides_[i].star});
  }

  // The edges, cut where is_cut(edge, corner) holds for an opposite corner.
  template <class IsCut>
  LargeArray<Edge> find(std::size_t vertices, const IsCut& is_cut, unsigned threads,
                        const base::Monitor& monitor) {
    std::vector<std::vector<Edge>> found(1);
    for (std::size_t t = 0; t < cells_.size(); ++t) {
      for (std::size_t k = 0; k < (width == 2 ? 1 : width); ++k) {
        const std::int32_t a = cells_[t][(k + 1) % width], b = cells_[t][(k + 2) % width];
        Edge side{{std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(t)};
        side.is_cut = std::uint32_t{width == 3 && is_cut(side, cells_[t][k])};
        found[0].push_back(side);
      }
    }
    sides_ = sort_edges(std::move(found), vertices, threads, monitor);
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      if (i == 0 || sides_[i].ends != sides_[i - 1].ends)
        edges.push_back({sides_[i].ends, static_cast<std::uint32_t>(i)});
      edges.back().is_cut |= sides_[i].is_cut;
    }
    LargeArray<Edge> result(edges.size());
    std::copy(edges.begin(), edges.end(), result.data());
    return result;
  }

 private:
  std::span<const Cell> cells_;
  LargeArray<Edge> sides_;  // of cells: each edge once for each one around it
};

}  // namespace vorotool::core::tetrahedral_alpha
