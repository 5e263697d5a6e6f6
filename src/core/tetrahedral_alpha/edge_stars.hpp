// The edges of tetrahedra, triangles or other edges, each with the cells around it.
#pragma once

#include <algorithm>
#include <array>
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

using Ends = std::array<std::int32_t, 2>;

// The number of the side between two corners of a cell.
inline constexpr std::array<std::array<std::uint8_t, 4>, 4> side_between{
    {{7, 0, 1, 2}, {0, 7, 3, 4}, {1, 3, 7, 5}, {2, 4, 5, 7}}};

// The edges from one vertex to later ones, of which the cells around it have several sides each. Edges and sides are
// words: twice the later end, and 1 where it is cut.
class VertexEdges {
 public:
  // Forgets all; there is room for so many sides.
  void reset(std::size_t most) {
    count_ = 0;
    if (sides_.size() > most) return;
    for (std::vector<std::uint32_t>* each : {&sides_, &numbers_, &places_, &edges_, &sorted_, &order_})
      each->resize(2 * most + 1);
  }

  // Adds a side with a number if is_added, without a branch.
  void add(std::size_t number, std::int32_t end, unsigned is_cut, bool is_added) {
    sides_[count_] = 2 * static_cast<std::uint32_t>(end) | is_cut;
    numbers_[count_] = static_cast<std::uint32_t>(number);
    count_ += static_cast<std::size_t>(is_added);
  }

  // The edges in the order of their ends.
  std::span<const std::uint32_t> find() {
    const int bits = static_cast<int>(std::bit_width(count_));
    const std::size_t last = (std::size_t{1} << bits) - 1;
    slots_.assign(last + 1, none);
    std::uint64_t* const slots = slots_.data();
    std::uint32_t* const edges = edges_.data();
    std::uint32_t distinct = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const std::uint32_t side = sides_[i], end = side / 2;
      std::size_t at = end * 0x9e3779b1U >> (32 - bits);
      while (is_another(slots[at], end)) at = (at + 1) & last;
      const std::uint64_t slot = slots[at];
      const bool is_new = slot == none;
      const std::uint32_t place = is_new ? distinct : static_cast<std::uint32_t>(slot);
      slots[at] = std::uint64_t{end} << 32 | place;
      edges[distinct] = side & ~1U;  // it is the last one, or none
      edges[place] |= side & 1U;
      places_[i] = place;
      distinct += static_cast<std::uint32_t>(is_new);
    }
    sort(distinct);
    return std::span(sorted_).first(distinct);
  }

  // Calls visit(number, k) for the sides that were added, where k is the edge.
  template <class Visit>
  void visit_sides(const Visit& visit) const {
    for (std::size_t i = 0; i < count_; ++i) visit(numbers_[i], order_[places_[i]]);
  }

 private:
  static constexpr std::size_t few = 32;
  static constexpr std::uint64_t none = ~std::uint64_t{0};

  // Whether a slot is taken by another end: one branch, since products of 32 bits are 0 only where a factor is.
  static bool is_another(std::uint64_t slot, std::uint32_t end) {
    const auto taken = static_cast<std::uint32_t>(slot >> 32);
    return std::uint64_t{taken - end} * (taken + 1U) != 0;
  }

  // Each edge goes behind those with lesser ends, which few edges count without a branch.
  void sort(std::size_t count) {
    if (count <= few) {
      const std::uint32_t* const edges = edges_.data();
      for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t edge = edges[k];
        std::uint32_t less = 0;
        for (std::size_t i = 0; i < count; ++i) less += static_cast<std::uint32_t>(edges[i] < edge);
        order_[k] = less;
      }
    } else {
      std::iota(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(count), 0U);
      std::sort(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(count),
                [this](std::uint32_t p, std::uint32_t q) { return edges_[p] < edges_[q]; });
      for (std::size_t k = 0; k < count; ++k) order_[sorted_[k]] = static_cast<std::uint32_t>(k);
    }
    for (std::size_t k = 0; k < count; ++k) sorted_[order_[k]] = edges_[k];
  }

  std::size_t count_ = 0;  // of sides
  std::vector<std::uint32_t> sides_, numbers_,
      places_;  // of sides; their edges in the order in which they come
  std::vector<std::uint32_t> edges_, sorted_, order_;  // of edges in this order, and where each goes
  std::vector<std::uint64_t> slots_;                   // ends, and places of edges
};

// The cells at each vertex but those of which it is the last corner: all that have an edge to a later vertex. Vertices
// are numbered so that cells next to each other have near ones. They are found in blocks of vertices, which no two
// threads share.
template <std::size_t width>
class EdgeStars {
 public:
  using Cell = std::array<std::int32_t, width>;

  EdgeStars(std::span<const Cell> cells, std::size_t vertices, unsigned threads, base::Passes& passes)
      : vertices_(vertices),
        threads_(threads),
        passes_(passes),
        shift_(std::max(12, static_cast<int>(std::bit_width(vertices)) - 11)),
        block_start_((vertices >> shift_) + 2),
        end_(vertices),
        edge_start_(vertices + 1) {
    gather(cells);
  }

  struct Edges {
    LargeArray<Ends> ends;            // in increasing order, the smaller one first
    LargeArray<std::uint8_t> is_cut;  // by one of the cells around it
  };

  // The edges; cut(t) has the bits of the sides of a cell that it cuts.
  template <class Cut>
  Edges find(std::span<const Cell> cells, const Cut& cut) {
    places_ = LargeArray<std::uint8_t>(sides * members_.size());
    std::vector<std::vector<std::uint32_t>> found(blocks());  // twice the later end, and whether it is cut
    for_blocks([&](std::size_t block) {
      sort_block(cells, block);
      VertexEdges edges;
      for (std::size_t v = first_of(block); v < first_of(block + 1); ++v) {
        gather_sides(v, cells, cut, edges);
        const auto sorted = edges.find();
        found[block].insert(found[block].end(), sorted.begin(), sorted.end());
        edge_start_[v + 1] = static_cast<std::uint32_t>(sorted.size());
        std::uint8_t* const places = places_.data() + sides * begin_of(v);
        std::fill(places, places_.data() + sides * end_[v], static_cast<std::uint8_t>(sorted.size()));
        edges.visit_sides(
            [&](std::size_t side, std::uint32_t k) { places[side] = static_cast<std::uint8_t>(k); });
      }
    });
    std::partial_sum(edge_start_.begin(), edge_start_.end(), edge_start_.begin());
    return write(found);
  }

  // Calls body.start(first, last) for the edges first ... last - 1 from each vertex, body.visit(t, k, edges) for the
  // cells around them, and body.end(first, last): k is the corner of the vertex, and first + edges[j] the edge to the
  // j-th of the corners behind it, in a circle, or `last` if that comes before. end_of(t, k) is the number of a corner.
  // Each block has a body.
  template <class EndOf, class MakeBody>
  void visit(const LargeArray<Ends>& edges, const EndOf& end_of, const MakeBody& make_body) const {
    for_blocks([&](std::size_t block) {
      auto body = make_body();
      for (std::size_t v = first_of(block); v < first_of(block + 1); ++v) {
        const std::size_t first = edge_start_[v], last = edge_start_[v + 1];
        body.start(first, last);
        const auto search = [&](std::size_t t, std::size_t k) {
          const Ends wanted{static_cast<std::int32_t>(v), end_of(t, k)};
          if (wanted[1] < wanted[0]) return last - first;
          return static_cast<std::size_t>(
                     std::lower_bound(edges.data() + first, edges.data() + last, wanted) - edges.data()) -
                 first;
        };
        for (std::size_t i = begin_of(v); i < end_[v]; ++i) {
          const std::size_t t = members_[i] / 4, k = members_[i] % 4;
          body.prefetch(later_member(i, v) / 4);
          std::array<std::size_t, sides> places;
          if (last - first < many) {
            for (std::size_t j = 0; j < sides; ++j) places[j] = places_[sides * i + j];
          } else {
            for (std::size_t j = 0; j < sides; ++j) places[j] = search(t, (k + 1 + j) % width);
          }
          body.visit(t, k, places);
        }
        body.end(first, last);
      }
    });
  }

 private:
  static constexpr std::size_t sides = width - 1;                   // of a member, at its vertex
  static constexpr std::size_t least_piece = std::size_t{1} << 16;  // cells: some milliseconds
  static constexpr std::size_t many = 0xff;  // edges of a vertex that bytes do not number
  static constexpr std::size_t ahead = 32;   // members whose cells are loaded before their turn

  std::size_t blocks() const { return block_start_.size() - 1; }
  std::size_t first_of(std::size_t block) const { return std::min(block << shift_, vertices_); }
  std::size_t begin_of(std::size_t v) const {
    return v % (std::size_t{1} << shift_) == 0 ? block_start_[v >> shift_] : end_[v - 1];
  }
  // In the block of a vertex: the next one may be another thread's.
  std::uint32_t later_member(std::size_t i, std::size_t v) const {
    return members_[std::min(i + ahead, block_start_[(v >> shift_) + 1] - 1)];
  }

  template <class Body>
  void for_blocks(const Body& body) const {
    base::parallel_for(blocks(), threads_, body, passes_.next());
  }

  // Calls visit(k, block of the vertex) for the corners of a cell but the last one.
  template <class Visit>
  void visit_corners(const Cell& cell, const Visit& visit) const {
    std::size_t last = 0;
    for (std::size_t k = 1; k < width; ++k) last = cell[k] > cell[last] ? k : last;
    for (std::size_t j = 1; j < width; ++j) {
      const std::size_t k = (last + j) % width;
      visit(k, at(cell[k]) >> shift_);
    }
  }

  // Members by their blocks.
  void gather(std::span<const Cell> cells) {
    const std::size_t grain = std::max(least_piece, cells.size() >> 11);
    std::vector<std::vector<std::uint32_t>> counts(base::piece_count(cells.size(), grain));
    base::for_pieces(cells.size(), grain, threads_, passes_.next(),
                     [&](std::size_t piece, std::size_t begin, std::size_t end) {
                       counts[piece].resize(blocks());
                       for (std::size_t t = begin; t < end; ++t)
                         visit_corners(cells[t],
                                       [&](std::size_t, std::size_t block) { ++counts[piece][block]; });
                     });
    std::size_t sum = 0;
    for (std::size_t block = 0; block < blocks(); ++block) {
      block_start_[block] = sum;
      for (auto& count : counts) sum += std::exchange(count[block], static_cast<std::uint32_t>(sum));
    }
    block_start_.back() = sum;
    members_ = LargeArray<std::uint32_t>(sum);
    base::for_pieces(cells.size(), grain, threads_, passes_.next(),
                     [&](std::size_t piece, std::size_t begin, std::size_t end) {
                       for (std::size_t t = begin; t < end; ++t) {
                         visit_corners(cells[t], [&](std::size_t k, std::size_t block) {
                           members_[counts[piece][block]++] = static_cast<std::uint32_t>(4 * t + k);
                         });
                       }
                     });
  }

  // By their vertices.
  void sort_block(std::span<const Cell> cells, std::size_t block) {
    const std::size_t first = first_of(block), count = first_of(block + 1) - first;
    const std::vector<std::uint32_t> given(members_.data() + block_start_[block],
                                           members_.data() + block_start_[block + 1]);
    const auto vertex_of = [&](std::uint32_t member) { return at(cells[member / 4][member % 4]) - first; };
    std::vector<std::uint32_t> ends(count + 1);
    for (const std::uint32_t member : given) ++ends[vertex_of(member) + 1];
    ends[0] = static_cast<std::uint32_t>(block_start_[block]);
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    for (const std::uint32_t member : given) members_[ends[vertex_of(member)]++] = member;
    std::copy_n(ends.begin(), count, end_.begin() + static_cast<std::ptrdiff_t>(first));
  }

  template <class Cut>
  void gather_sides(std::size_t v, std::span<const Cell> cells, const Cut& cut, VertexEdges& edges) const {
    const std::size_t begin = begin_of(v), end = end_[v];
    edges.reset(sides * (end - begin));
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t t = members_[i] / 4, k = members_[i] % 4;
      __builtin_prefetch(&cells[later_member(i, v) / 4]);
      const unsigned cut_sides = cut(t);
      for (std::size_t j = 0; j < sides; ++j) {
        const std::size_t l = (k + 1 + j) % width;
        edges.add(sides * (i - begin) + j, cells[t][l], cut_sides >> side_between[k][l] & 1U,
                  at(cells[t][l]) > v);
      }
    }
  }

  Edges write(std::vector<std::vector<std::uint32_t>>& found) const {
    Edges edges{LargeArray<Ends>(edge_start_.back()), LargeArray<std::uint8_t>(edge_start_.back())};
    for_blocks([&](std::size_t block) {
      const std::uint32_t* word = found[block].data();
      for (std::size_t v = first_of(block); v < first_of(block + 1); ++v) {
        for (std::size_t e = edge_start_[v]; e < edge_start_[v + 1]; ++e, ++word) {
          edges.ends[e] = {static_cast<std::int32_t>(v), static_cast<std::int32_t>(*word / 2)};
          edges.is_cut[e] = *word & 1U;
        }
      }
      std::vector<std::uint32_t>().swap(found[block]);
    });
    return edges;
  }

  std::size_t vertices_;
  unsigned threads_;
  base::Passes& passes_;  // of which gathering takes two, finding two, and a visit one
  int shift_;             // a block has so many bits of vertices
  std::vector<std::size_t> block_start_;
  LargeArray<std::uint32_t> members_;      // 4 t + k by blocks, then by vertices
  LargeArray<std::uint8_t> places_;        // of the sides of members among the edges of the vertex
  std::vector<std::uint32_t> end_;         // [vertices] of their members
  std::vector<std::uint32_t> edge_start_;  // [vertices + 1]
};

}  // namespace vorotool::core::tetrahedral_alpha
