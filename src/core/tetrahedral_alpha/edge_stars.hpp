// The edges of tetrahedra, triangles or other edges, each with the cells around it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/flat_map.hpp"
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

// Memory for edges from the vertices of a block to later ones. Words have an end in their upper half.
struct BlockEdges {
  // Slots of a vertex, which has some eight edges to later ones where points are random; what finds none goes to a map.
  static constexpr int window_bits = 5;
  static constexpr std::size_t window = std::size_t{1} << window_bits, most_tries = 16;

  void reset(std::size_t vertices) {
    slots.assign(window * vertices, 0);
    more = base::FlatMap();
    grow(4 * vertices);
    std::fill(is_cut.begin(), is_cut.end(), std::uint8_t{0});
  }

  void grow(std::size_t size) {
    if (edges.size() < size) edges.resize(size), is_cut.resize(size);
  }

  std::vector<std::uint64_t> slots;  // [vertices][window] with numbers of edges, from 1; 0 is empty
  base::FlatMap more;                // the same by the vertex and the end
  std::vector<std::uint64_t> edges;  // with the vertices of the block, and room for more
  std::vector<std::uint8_t> is_cut;  // of them
};

// Numbers edges in the order in which they first come. What it has of the memory is in registers.
class EdgeNumbers {
 public:
  explicit EdgeNumbers(BlockEdges& block)
      : block_(block), slots_(block.slots.data()), edges_(block.edges.data()), is_cut_(block.is_cut.data()) {}

  std::uint32_t count() const { return count_; }

  // Makes room for so many edges more.
  void reserve(std::size_t more) {
    if (count_ + more < block_.edges.size()) return;
    block_.grow(2 * block_.edges.size() + more);
    edges_ = block_.edges.data(), is_cut_ = block_.is_cut.data();
  }

  // The number of the edge between a vertex of the block and a later one; the last bit of `cut` is its.
  std::uint32_t find(std::uint32_t vertex, std::uint32_t end, unsigned cut) {
    std::uint64_t* slot = slots_ + BlockEdges::window * vertex + place_of(end);
    if (is_another(*slot, end)) [[unlikely]]
      slot = search(block_, vertex, end);
    // Without a branch, since one of five is new and which ones cannot be foreseen.
    const auto is_new = static_cast<std::uint32_t>(*slot == 0);
    const std::uint32_t number = static_cast<std::uint32_t>(*slot) - 1 + ((0 - is_new) & (count_ + 1));
    const std::uint64_t upper = std::uint64_t{end} << 32;
    *slot = upper | (number + 1);
    edges_[count_] = upper | vertex;  // it is the last one, or none
    is_cut_[number] |= static_cast<std::uint8_t>(cut & 1U);
    count_ += is_new;
    return number;
  }

 private:
  static std::size_t place_of(std::uint32_t end) {
    return end * 0x9e3779b1U >> (32 - BlockEdges::window_bits);
  }

  static bool is_another(std::uint64_t slot, std::uint32_t end) {
    return (static_cast<unsigned>(slot != 0) & static_cast<unsigned>(slot >> 32 != end)) != 0;
  }

  [[gnu::noinline]] static std::uint64_t* search(BlockEdges& block, std::uint32_t vertex, std::uint32_t end) {
    std::uint64_t* const slots = block.slots.data() + BlockEdges::window * vertex;
    std::size_t at = place_of(end);
    for (std::size_t tries = 1; tries < BlockEdges::most_tries; ++tries) {
      at = (at + 1) % BlockEdges::window;
      if (!is_another(slots[at], end)) return &slots[at];
    }
    return &block.more[(std::uint64_t{vertex} + 1) << 32 | end];
  }

  BlockEdges& block_;
  std::uint64_t *slots_, *edges_;
  std::uint8_t* is_cut_;
  std::uint32_t count_ = 0;
};

// The corners of a cell in the order of their vertices, and its sides in the order of these.
template <std::size_t width>
class CornerOrder {
 public:
  CornerOrder() = default;
  explicit CornerOrder(const std::array<std::int32_t, width>& cell) : word_(0) {
    std::array<unsigned, width> place{};
    for (std::size_t k = 1; k < width; ++k) {
      for (std::size_t l = 0; l < k; ++l) {
        const auto is_less = static_cast<unsigned>(cell[l] < cell[k]);
        place[k] += is_less, place[l] += 1 - is_less;
      }
    }
    for (std::size_t k = 0; k < width; ++k) word_ = static_cast<std::uint8_t>(word_ | k << 2 * place[k]);
  }

  std::size_t operator[](std::size_t place) const { return corner(word_, place); }

  // Bits of sides, as side_between numbers them by the corners, by the places of the corners.
  unsigned sides(unsigned by_corners) const { return sides_by_places[word_][by_corners]; }

 private:
  static constexpr std::size_t corner(std::size_t word, std::size_t place) { return word >> 2 * place & 3; }

  static constexpr auto sides_by_places = [] {
    std::array<std::array<std::uint8_t, 64>, 256> all{};
    for (std::size_t word = 0; word < all.size(); ++word) {
      for (std::size_t p = 0; p < width; ++p) {
        for (std::size_t q = p + 1; q < width; ++q) {
          const unsigned side = side_between[corner(word, p)][corner(word, q)];
          for (unsigned bits = 0; bits < 64; ++bits)
            all[word][bits] =
                static_cast<std::uint8_t>(all[word][bits] | (bits >> side & 1U) << side_between[p][q]);
        }
      }
    }
    return all;
  }();

  std::uint8_t word_;
};

// An edge belongs to the block of its first vertex. Vertices are numbered so that cells next to each other have near
// ones: most cells have all their edges in one block. Blocks are shared by no two threads.
template <std::size_t width>
class EdgeStars {
 public:
  using Cell = std::array<std::int32_t, width>;
  using Order = CornerOrder<width>;

  EdgeStars(std::span<const Cell> cells, std::size_t vertices, unsigned threads, base::Passes& passes)
      : vertices_(vertices),
        threads_(threads),
        passes_(passes),
        shift_(std::max(12, static_cast<int>(std::bit_width(vertices)) - 13)),
        block_start_((vertices >> shift_) + 2),
        side_start_(block_start_.size()),
        edge_start_(block_start_.size()),
        order_(cells.size()),
        wide_(blocks()) {
    gather(cells);
  }

  struct Edges {
    LargeArray<Ends> ends;  // by blocks, in the order in which they first come; the smaller one first
    LargeArray<std::uint8_t> is_cut;  // by one of the cells around it
  };

  // The edges; cut(t) has the bits of the sides of a cell that it cuts.
  template <class Cut>
  Edges find(std::span<const Cell> cells, const Cut& cut) {
    edge_ = LargeArray<std::uint16_t>(side_start_.back());
    std::vector<Words> found(blocks());
    const std::size_t grain = std::clamp<std::size_t>(blocks() / 64, 1, 8);  // blocks with one memory
    base::for_pieces(
        blocks(), grain, threads_, passes_.next(), [&](std::size_t, std::size_t begin, std::size_t end) {
          BlockEdges memory;
          for (std::size_t block = begin; block < end; ++block) {
            found[block] = number_edges(block, cells, cut, memory, edge_.data() + side_start_[block]);
            if (found[block].size() > std::size_t{1} << 16) {
              wide_[block].resize(side_start_[block + 1] - side_start_[block]);
              number_edges(block, cells, cut, memory, wide_[block].data());
            }
            edge_start_[block + 1] = found[block].size();
          }
        });
    std::partial_sum(edge_start_.begin(), edge_start_.end(), edge_start_.begin());
    return write(found);
  }

  // Calls body.start(first, last) for the edges first ... last - 1 of each block, body.visit(t, order, in_block, edges)
  // for the cells of which it has some, and body.end(first, last). Bits of in_block are the places in the order of the
  // corners from which edges to the corners behind them are in the block: these are first + *edges++, one after the
  // other. Each block has a body.
  template <class MakeBody>
  void visit(const MakeBody& make_body) const {
    for_blocks([&](std::size_t block) {
      auto body = make_body();
      body.start(edge_start_[block], edge_start_[block + 1]);
      const auto visit_cells = [&](const auto* edges) {
        for_cells(
            block, [&](std::size_t t, unsigned in_block) { body.visit(t, order_[t], in_block, edges); },
            [&](std::size_t t) { body.prefetch(t); });
      };
      if (wide_[block].empty()) {
        visit_cells(edge_.data() + side_start_[block]);
      } else {
        visit_cells(wide_[block].data());
      }
      body.end(edge_start_[block], edge_start_[block + 1]);
    });
  }

  // Calls visit(place) for the places of which in_block has bits; the place is a constant.
  template <class Visit>
  static void for_places(unsigned in_block, const Visit& visit) {
    [&]<std::size_t... place>(std::index_sequence<place...>) {
      ((in_block >> place & 1U ? visit(std::integral_constant<std::size_t, place>()) : void()), ...);
    }(std::make_index_sequence<places>());
  }

 private:
  using Words = std::vector<std::uint64_t>;

  static constexpr std::size_t places = width - 1;  // in a cell, but the last
  static constexpr std::size_t sides = width * places / 2;
  static constexpr std::size_t least_piece = std::size_t{1} << 16;  // cells: some milliseconds
  static constexpr std::size_t ahead = 24;                          // cells that are loaded before their turn

  std::size_t blocks() const { return block_start_.size() - 1; }
  std::size_t first_of(std::size_t block) const { return std::min(block << shift_, vertices_); }

  template <class Body>
  void for_blocks(const Body& body) const {
    base::parallel_for(blocks(), threads_, body, passes_.next());
  }

  // Calls visit(t, in_block) for the cells of a block, and prefetch(t) for those that come some time later.
  template <class Visit, class Prefetch>
  void for_cells(std::size_t block, const Visit& visit, const Prefetch& prefetch) const {
    const std::size_t end = block_start_[block + 1];
    for (std::size_t i = block_start_[block]; i < end; ++i) {
      const std::size_t next = cell_[std::min(i + ahead, end - 1)] >> places;
      __builtin_prefetch(&order_[next]);
      prefetch(next);
      visit(cell_[i] >> places, cell_[i] & ((1U << places) - 1));
    }
  }

  // The cells of each block, with the places that are in it.
  void gather(std::span<const Cell> cells) {
    const std::size_t grain = std::max(least_piece, cells.size() >> 9);
    std::vector<std::vector<std::uint32_t>> counts(base::piece_count(cells.size(), grain));
    std::vector<std::vector<std::uint32_t>> sides(counts.size());
    const auto in_pieces = [&](const auto& start, const auto& visit) {
      base::for_pieces(cells.size(), grain, threads_, passes_.next(),
                       [&](std::size_t piece, std::size_t begin, std::size_t end) {
                         start(piece, begin, end);
                         for (std::size_t t = begin; t < end; ++t) {
                           std::size_t block = block_of(cells, t, 0);
                           unsigned in_block = 1;
                           for (std::size_t place = 1; place < places; ++place) {
                             const std::size_t next = block_of(cells, t, place);
                             if (next != block)
                               visit(piece, t, std::exchange(block, next), std::exchange(in_block, 0));
                             in_block |= 1U << place;
                           }
                           visit(piece, t, block, in_block);
                         }
                       });
    };
    const auto order_corners = [&](std::size_t piece, std::size_t begin, std::size_t end) {
      counts[piece].resize(blocks()), sides[piece].resize(blocks());
      for (std::size_t t = begin; t < end; ++t) order_[t] = Order(cells[t]);
    };
    in_pieces(order_corners, [&](std::size_t piece, std::size_t, std::size_t block, unsigned in_block) {
      ++counts[piece][block];
      for_places(in_block,
                 [&](auto place) { sides[piece][block] += static_cast<std::uint32_t>(places - place); });
    });
    std::size_t sum = 0, side_sum = 0;
    for (std::size_t block = 0; block < blocks(); ++block) {
      block_start_[block] = sum, side_start_[block] = side_sum;
      for (auto& count : counts) sum += std::exchange(count[block], static_cast<std::uint32_t>(sum));
      for (const auto& side : sides) side_sum += side[block];
    }
    block_start_.back() = sum, side_start_.back() = side_sum;
    cell_ = LargeArray<std::uint32_t>(sum);
    const auto nothing = [](std::size_t, std::size_t, std::size_t) {};
    in_pieces(nothing, [&](std::size_t piece, std::size_t t, std::size_t block, unsigned in_block) {
      cell_[counts[piece][block]++] = static_cast<std::uint32_t>(t << places | in_block);
    });
  }

  std::size_t block_of(std::span<const Cell> cells, std::size_t t, std::size_t place) const {
    return at(cells[t][order_[t][place]]) >> shift_;
  }

  // The edges of a block, of which the numbers are written for all sides of its cells: words with twice the end, and 1
  // where it is cut, above the vertex of the block.
  template <class Cut, class Number>
  Words number_edges(std::size_t block, std::span<const Cell> cells, const Cut& cut, BlockEdges& memory,
                     Number* next) const {
    const std::size_t first = first_of(block);
    memory.reset(first_of(block + 1) - first);
    EdgeNumbers numbers(memory);
    const auto prefetch = [&](std::size_t t) { __builtin_prefetch(&cells[t]); };
    const auto number_sides = [&](std::size_t t, unsigned in_block) {
      const Order order = order_[t];
      const unsigned cut_sides = order.sides(cut(t));
      std::array<std::uint32_t, width> ends;
      for (std::size_t place = 0; place < width; ++place)
        ends[place] = static_cast<std::uint32_t>(cells[t][order[place]]);
      numbers.reserve(sides);
      for_places(in_block, [&](auto place) {
        const auto vertex = static_cast<std::uint32_t>(ends[place] - first);
        for (std::size_t later = place + 1; later < width; ++later)
          *next++ =
              static_cast<Number>(numbers.find(vertex, ends[later], cut_sides >> side_between[place][later]));
      });
    };
    for_cells(block, number_sides, prefetch);
    Words words(memory.edges.begin(), memory.edges.begin() + numbers.count());
    for (std::size_t e = 0; e < words.size(); ++e)
      words[e] = static_cast<std::uint32_t>(words[e]) | (words[e] >> 32 << 1 | memory.is_cut[e]) << 32;
    return words;
  }

  Edges write(std::vector<Words>& found) const {
    Edges edges{LargeArray<Ends>(edge_start_.back()), LargeArray<std::uint8_t>(edge_start_.back())};
    for_blocks([&](std::size_t block) {
      std::size_t e = edge_start_[block];
      for (const std::uint64_t word : found[block]) {
        edges.ends[e] = {static_cast<std::int32_t>(first_of(block) + static_cast<std::uint32_t>(word)),
                         static_cast<std::int32_t>(word >> 33)};
        edges.is_cut[e++] = word >> 32 & 1U;
      }
      Words().swap(found[block]);
    });
    return edges;
  }

  std::size_t vertices_;
  unsigned threads_;
  base::Passes& passes_;                  // of which gathering takes two, finding two, and a visit one
  int shift_;                             // a block has so many bits of vertices
  std::vector<std::size_t> block_start_;  // of cells
  std::vector<std::size_t> side_start_;   // of blocks
  std::vector<std::size_t> edge_start_;   // of blocks
  LargeArray<Order> order_;               // [t]
  LargeArray<std::uint32_t> cell_;        // t and the places in the block, by blocks
  LargeArray<std::uint16_t> edge_;        // [sides] of cells, in their order: which edge of the block
  std::vector<std::vector<std::uint32_t>> wide_;  // [blocks] the same where the block has too many edges
};

}  // namespace vorotool::core::tetrahedral_alpha
