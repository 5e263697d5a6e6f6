// The edges of tetrahedra or triangles, each with the cells around it.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/base/parallel.hpp"

namespace vorotool::core::tetrahedral_alpha {

using base::at;
using base::LargeArray;

// Cells of `width` corners. Vertices are taken in the order in which they first appear in the cells, so that those near
// each other come together, and each edge at the first of its ends.
template <std::size_t width>
class EdgeStars {
 public:
  using Cell = std::array<std::int32_t, width>;
  using Ends = std::array<std::int32_t, 2>;

  // An edge seen from a cell: which corners of the cell are its ends.
  struct Visit {
    std::size_t cell, first, second;
  };

  EdgeStars(std::span<const Cell> cells, std::size_t points, unsigned threads, const base::Monitor& monitor)
      : cells_(cells),
        threads_(threads),
        monitor_(monitor),
        place_(points, base::no_index),
        next_(width * cells.size()) {
    for (const Cell& cell : cells) {
      for (const std::int32_t v : cell) {
        if (place_[at(v)] != base::no_index) continue;
        place_[at(v)] = static_cast<std::int32_t>(order_.size());
        order_.push_back(v);
      }
    }
    std::vector<std::atomic<std::int32_t>> head(order_.size());
    for (auto& corner : head) corner.store(base::no_index, std::memory_order_relaxed);
    base::for_items(cells.size(), cells_a_piece, threads, monitor, [&](std::size_t t) {
      for (std::size_t k = 0; k < width; ++k) {
        const std::size_t corner = width * t + k;
        next_[corner] = head[at(place_[at(cells[t][k])])].exchange(static_cast<std::int32_t>(corner),
                                                                   std::memory_order_relaxed);
      }
    });
    head_.resize(head.size());
    for (std::size_t i = 0; i < head.size(); ++i) head_[i] = head[i].load(std::memory_order_relaxed);
    find_edges();
  }

  std::size_t size() const { return ends_.size(); }
  const Ends& ends(std::size_t edge) const { return ends_[edge]; }
  LargeArray<Ends> release() { return std::move(ends_); }

  // Calls visit(edge, Visit) for all edges and cells around them; those of one edge on one thread.
  template <class Function>
  void for_visits(const Function& function) const {
    base::for_pieces(order_.size(), vertices_a_piece, threads_, monitor_,
                     [&](std::size_t, std::size_t begin, std::size_t end) {
                       Table table;
                       for (std::size_t i = begin; i < end; ++i) visit_star(table, i, function);
                     });
  }

 private:
  static constexpr std::size_t cells_a_piece = std::size_t{1} << 13, vertices_a_piece = std::size_t{1} << 11;

  // Vertices and a number of each, by open addressing.
  class Table {
   public:
    void reset(std::size_t most) {
      const std::size_t size = std::bit_ceil(2 * most + 2);
      slots_.assign(size, {base::no_index, 0});
      mask_ = size - 1;
    }
    // The slot of a vertex, and whether it is new.
    std::pair<std::int32_t*, bool> find(std::int32_t vertex) {
      std::size_t i = (static_cast<std::uint32_t>(vertex) * 0x9E3779B1u >> 7) & mask_;
      while (slots_[i].first != vertex && slots_[i].first != base::no_index) i = (i + 1) & mask_;
      const bool is_new = slots_[i].first == base::no_index;
      slots_[i].first = vertex;
      return {&slots_[i].second, is_new};
    }

   private:
    std::vector<std::pair<std::int32_t, std::int32_t>> slots_;
    std::size_t mask_ = 0;
  };

  std::size_t cells_around(std::size_t i) const {
    std::size_t count = 0;
    for (std::int32_t corner = head_[i]; corner >= 0; corner = next_[at(corner)]) ++count;
    return count;
  }

  // Calls visit(other end, Visit) for the cells around edges of a vertex that come after it.
  template <class Function>
  void visit_later(std::size_t i, const Function& function) const {
    for (std::int32_t corner = head_[i]; corner >= 0; corner = next_[at(corner)]) {
      const std::size_t t = at(corner) / width, first = at(corner) % width;
      for (std::size_t second = 0; second < width; ++second) {
        const std::int32_t b = cells_[t][second];
        if (place_[at(b)] > static_cast<std::int32_t>(i)) function(b, Visit{t, first, second});
      }
    }
  }

  void find_edges() {
    std::vector<std::vector<std::int32_t>> found(base::piece_count(order_.size(), vertices_a_piece));
    start_.assign(order_.size() + 1, 0);
    base::for_pieces(order_.size(), vertices_a_piece, threads_, monitor_,
                     [&](std::size_t piece, std::size_t begin, std::size_t end) {
                       Table table;
                       for (std::size_t i = begin; i < end; ++i) {
                         table.reset(width * cells_around(i));
                         const std::size_t before = found[piece].size();
                         visit_later(i, [&](std::int32_t b, const Visit&) {
                           if (table.find(b).second) found[piece].push_back(b);
                         });
                         std::sort(
                             found[piece].begin() + static_cast<std::ptrdiff_t>(before), found[piece].end(),
                             [&](std::int32_t p, std::int32_t q) { return place_[at(p)] < place_[at(q)]; });
                         start_[i + 1] = found[piece].size() - before;
                       }
                     });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    ends_ = LargeArray<Ends>(start_.back());
    base::for_pieces(order_.size(), vertices_a_piece, threads_, monitor_,
                     [&](std::size_t piece, std::size_t begin, std::size_t end) {
                       const std::int32_t* other = found[piece].data();
                       for (std::size_t i = begin; i < end; ++i) {
                         for (std::size_t e = start_[i]; e < start_[i + 1]; ++e) {
                           ends_[e] = {std::min(order_[i], *other), std::max(order_[i], *other)};
                           ++other;
                         }
                       }
                       found[piece] = {};
                     });
  }

  template <class Function>
  void visit_star(Table& table, std::size_t i, const Function& function) const {
    if (start_[i] == start_[i + 1]) return;
    table.reset(start_[i + 1] - start_[i]);
    for (std::size_t e = start_[i]; e < start_[i + 1]; ++e) {
      const std::int32_t other = ends_[e][0] == order_[i] ? ends_[e][1] : ends_[e][0];
      *table.find(other).first = static_cast<std::int32_t>(e - start_[i]);
    }
    visit_later(i, [&](std::int32_t b, const Visit& visit) {
      function(start_[i] + at(*table.find(b).first), visit);
    });
  }

  std::span<const Cell> cells_;
  unsigned threads_;
  const base::Monitor& monitor_;
  std::vector<std::int32_t> place_;  // [points] place of each vertex in the order, -1 of those without a cell
  std::vector<std::int32_t> order_;  // vertices
  std::vector<std::int32_t> head_;   // [order] width t + k of a cell around each vertex
  LargeArray<std::int32_t> next_;    // [width t] and the next one, or -1
  std::vector<std::size_t> start_;   // [order + 1] edges of each vertex with later ones
  LargeArray<Ends> ends_;
};

}  // namespace vorotool::core::tetrahedral_alpha
