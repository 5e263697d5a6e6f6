// The edges of tetrahedra or triangles, each with the cells around it.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
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

// Cells of `width` corners. Vertices get new numbers, in the order in which they first appear in the cells, so that those
// near each other come together. An edge belongs to the first of its ends.
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
      : cells_(cells.size()), threads_(threads), monitor_(monitor), next_(width * cells.size()) {
    number_vertices(cells, points);
    list_cells();
  }

  // [cells] with the new numbers, and the old ones of those.
  const Cell& cell(std::size_t t) const { return cells_[t]; }
  std::span<const std::int32_t> order() const { return order_; }

  // Finds the edges; a mark of each tells whether holds(Visit) for a cell around it. It is not asked again once it did.
  template <class Holds>
  LargeArray<std::uint8_t> find_edges(const Holds& holds) {
    std::vector<std::vector<Found>> found(base::piece_count(order_.size(), vertices_a_piece));
    start_.assign(order_.size() + 1, 0);
    for_vertices(
        [&](std::size_t piece, std::size_t begin, std::size_t end, std::vector<std::int32_t>& slots) {
          std::vector<Found>& list = found[piece];
          for (std::size_t i = begin; i < end; ++i) {
            const std::size_t before = list.size();
            visit_later(i, [&](std::int32_t b, const Visit& visit) {
              std::size_t slot = before + at(slots[at(b)]);
              if (slot >= list.size() || list[slot].other != b) {
                slot = list.size();
                slots[at(b)] = static_cast<std::int32_t>(slot - before);
                list.push_back({b, 0});
              }
              if (list[slot].mark == 0 && holds(visit)) list[slot].mark = 1;
            });
            std::sort(list.begin() + static_cast<std::ptrdiff_t>(before), list.end(),
                      [](const Found& p, const Found& q) { return p.other < q.other; });
            start_[i + 1] = list.size() - before;
          }
        });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    ends_ = LargeArray<Ends>(start_.back());
    LargeArray<std::uint8_t> marks(start_.back());
    base::for_pieces(order_.size(), vertices_a_piece, threads_, monitor_,
                     [&](std::size_t piece, std::size_t begin, std::size_t end) {
                       const Found* next = found[piece].data();
                       for (std::size_t i = begin; i < end; ++i) {
                         for (std::size_t e = start_[i]; e < start_[i + 1]; ++e, ++next) {
                           ends_[e] = {static_cast<std::int32_t>(i), next->other};
                           marks[e] = next->mark;
                         }
                       }
                       found[piece] = {};
                     });
    return marks;
  }

  std::size_t size() const { return ends_.size(); }
  const Ends& ends(std::size_t edge) const { return ends_[edge]; }

  // Calls visit(edge, Visit) for all edges and cells around them; those of one edge on one thread.
  template <class Function>
  void for_visits(const Function& function) {
    for_vertices([&](std::size_t, std::size_t begin, std::size_t end, std::vector<std::int32_t>& slots) {
      for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t e = start_[i]; e < start_[i + 1]; ++e)
          slots[at(ends_[e][1])] = static_cast<std::int32_t>(e - start_[i]);
        visit_later(
            i, [&](std::int32_t b, const Visit& visit) { function(start_[i] + at(slots[at(b)]), visit); });
      }
    });
  }

 private:
  static constexpr std::size_t cells_a_piece = std::size_t{1} << 13, vertices_a_piece = std::size_t{1} << 11;

  struct Found {
    std::int32_t other;
    std::uint8_t mark;
  };

  void number_vertices(std::span<const Cell> cells, std::size_t points) {
    std::vector<std::int32_t> place(points, base::no_index);
    for (const Cell& cell : cells) {
      for (const std::int32_t v : cell) {
        if (place[at(v)] != base::no_index) continue;
        place[at(v)] = static_cast<std::int32_t>(order_.size());
        order_.push_back(v);
      }
    }
    base::for_items(cells.size(), cells_a_piece, threads_, monitor_, [&](std::size_t t) {
      for (std::size_t k = 0; k < width; ++k) cells_[t][k] = place[at(cells[t][k])];
    });
  }

  void list_cells() {
    std::vector<std::atomic<std::int32_t>> head(order_.size());
    for (auto& corner : head) corner.store(base::no_index, std::memory_order_relaxed);
    base::for_items(cells_.size(), cells_a_piece, threads_, monitor_, [&](std::size_t t) {
      for (std::size_t k = 0; k < width; ++k) {
        const std::size_t corner = width * t + k;
        next_[corner] =
            head[at(cells_[t][k])].exchange(static_cast<std::int32_t>(corner), std::memory_order_relaxed);
      }
    });
    head_.resize(head.size());
    for (std::size_t i = 0; i < head.size(); ++i) head_[i] = head[i].load(std::memory_order_relaxed);
  }

  // Calls work(piece, begin, end, slots) for pieces of the vertices, with a number for each vertex that no other thread
  // changes.
  template <class Work>
  void for_vertices(const Work& work) {
    std::mutex mutex;
    std::vector<std::unique_ptr<std::vector<std::int32_t>>> unused;
    base::for_pieces(order_.size(), vertices_a_piece, threads_, monitor_,
                     [&](std::size_t piece, std::size_t begin, std::size_t end) {
                       std::unique_ptr<std::vector<std::int32_t>> slots;
                       {
                         const std::lock_guard lock(mutex);
                         if (!unused.empty()) {
                           slots = std::move(unused.back());
                           unused.pop_back();
                         }
                       }
                       if (!slots) slots = std::make_unique<std::vector<std::int32_t>>(order_.size());
                       work(piece, begin, end, *slots);
                       const std::lock_guard lock(mutex);
                       unused.push_back(std::move(slots));
                     });
  }

  // Calls visit(other end, Visit) for the cells around edges of a vertex that come after it.
  template <class Function>
  void visit_later(std::size_t i, const Function& function) const {
    for (std::int32_t corner = head_[i]; corner >= 0; corner = next_[at(corner)]) {
      const std::size_t t = at(corner) / width, first = at(corner) % width;
      for (std::size_t second = 0; second < width; ++second) {
        const std::int32_t b = cells_[t][second];
        if (b > static_cast<std::int32_t>(i)) function(b, Visit{t, first, second});
      }
    }
  }

  LargeArray<Cell> cells_;
  unsigned threads_;
  const base::Monitor& monitor_;
  std::vector<std::int32_t> order_;  // the old numbers of vertices
  std::vector<std::int32_t> head_;   // [vertices] width t + k of a cell around each one
  LargeArray<std::int32_t> next_;    // [width t] and the next one, or -1
  std::vector<std::size_t> start_;   // [vertices + 1] edges of each one with later ones
  LargeArray<Ends> ends_;            // of new numbers, the smaller one first
};

}  // namespace vorotool::core::tetrahedral_alpha
