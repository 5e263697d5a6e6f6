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
    for (std::vector<std::uint32_t>* each : {&sides_, &places_, &edges_, &sorted_, &order_})
      each->resize(2 * most + 1);
  }

  void add(std::int32_t end, unsigned is_cut) {
    sides_[count_++] = 2 * static_cast<std::uint32_t>(end) | is_cut;
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

  // Writes which edge each side is; gives the end of what is written.
  std::uint8_t* write_places(std::uint8_t* out) const {
    for (std::size_t i = 0; i < count_; ++i) *out++ = static_cast<std::uint8_t>(order_[places_[i]]);
    return out;
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

  std::size_t count_ = 0;                      // of sides
  std::vector<std::uint32_t> sides_, places_;  // of sides; their edges in the order in which they come
  std::vector<std::uint32_t> edges_, sorted_, order_;  // of edges in this order, and where each goes
  std::vector<std::uint64_t> slots_;                   // ends, and places of edges
};

// The corners of a cell in the order of their vertices.
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

  std::size_t operator[](std::size_t place) const { return std::size_t{word_} >> 2 * place & 3; }

 private:
  std::uint8_t word_;
};

// The cells at each vertex but those of which it is the last corner: all that have an edge to a later vertex. Those of
// which it is the first corner come first, then those of which it is the second, and so on: they have one side to a later
// vertex less each. Vertices are numbered so that cells next to each other have near ones. They are found in blocks of
// vertices, which no two threads share.
template <std::size_t width>
class EdgeStars {
 public:
  using Cell = std::array<std::int32_t, width>;
  using Order = CornerOrder<width>;

  EdgeStars(std::span<const Cell> cells, std::size_t vertices, unsigned threads, base::Passes& passes)
      : vertices_(vertices),
        threads_(threads),
        passes_(passes),
        shift_(std::max(12, static_cast<int>(std::bit_width(vertices)) - 11)),
        block_start_((vertices >> shift_) + 2),
        order_(cells.size()),
        end_(places * vertices),
        side_start_(block_start_.size()),
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
    edge_ = LargeArray<std::uint8_t>(side_start_.back());
    std::vector<std::vector<std::uint32_t>> found(blocks());  // twice the later end, and whether it is cut
    for_blocks([&](std::size_t block) {
      sort_block(cells, block);
      found[block].reserve((block_start_[block + 1] - block_start_[block]) / 2);
      VertexEdges edges;
      std::uint8_t* next = edge_.data() + side_start_[block];
      for (std::size_t v = first_of(block); v < first_of(block + 1); ++v) {
        gather_sides(v, cells, cut, edges);
        const auto sorted = edges.find();
        found[block].insert(found[block].end(), sorted.begin(), sorted.end());
        edge_start_[v + 1] = static_cast<std::uint32_t>(sorted.size());
        next = edges.write_places(next);
      }
    });
    std::partial_sum(edge_start_.begin(), edge_start_.end(), edge_start_.begin());
    return write(found);
  }

  // Calls body.start(first, last) for the edges first ... last - 1 from each vertex, body.visit(place, t, order, edges)
  // for the cells around them, and body.end(first, last): the vertex is at this place in the order of the corners, and
  // first + edges[j] is the edge to the j-th of the corners behind it. end_of(t, k) is the number of a corner. Each block
  // has a body.
  template <class EndOf, class MakeBody>
  void visit(const LargeArray<Ends>& edges, const EndOf& end_of, const MakeBody& make_body) const {
    for_blocks([&](std::size_t block) {
      auto body = make_body();
      const std::uint8_t* next = edge_.data() + side_start_[block];
      for (std::size_t v = first_of(block); v < first_of(block + 1); ++v) {
        const std::size_t first = edge_start_[v], last = edge_start_[v + 1];
        const auto search = [&](std::int32_t end) {
          const auto at_end = [](const Ends& edge, std::int32_t wanted) { return edge[1] < wanted; };
          const Ends* const begin = edges.data() + first;
          return static_cast<std::size_t>(std::lower_bound(begin, edges.data() + last, end, at_end) - begin);
        };
        body.start(first, last);
        for_members(v, [&](auto place, std::size_t i) {
          const std::size_t t = members_[i] / 4;
          const Order order = order_[t];
          body.prefetch(later_member(i, v) / 4);
          std::array<std::size_t, places - place> found;
          for (std::size_t j = 0; j < found.size(); ++j)
            found[j] = last - first < many ? next[j] : search(end_of(t, order[place + 1 + j]));
          next += found.size();
          body.visit(place, t, order, found);
        });
        body.end(first, last);
      }
    });
  }

 private:
  static constexpr std::size_t places = width - 1;                  // in a cell, but the last
  static constexpr std::size_t least_piece = std::size_t{1} << 16;  // cells: some milliseconds
  static constexpr std::size_t many = 0xff;  // edges of a vertex that bytes do not number
  static constexpr std::size_t ahead = 32;   // members whose cells are loaded before their turn

  std::size_t blocks() const { return block_start_.size() - 1; }
  std::size_t first_of(std::size_t block) const { return std::min(block << shift_, vertices_); }
  std::size_t begin_of(std::size_t v) const {
    return v % (std::size_t{1} << shift_) == 0 ? block_start_[v >> shift_] : end_[places * v - 1];
  }
  // In the block of a vertex: the next one may be another thread's.
  std::uint32_t later_member(std::size_t i, std::size_t v) const {
    return members_[std::min(i + ahead, block_start_[(v >> shift_) + 1] - 1)];
  }

  template <class Body>
  void for_blocks(const Body& body) const {
    base::parallel_for(blocks(), threads_, body, passes_.next());
  }

  // Calls visit(place, i) for the members of a vertex; the place is a constant.
  template <class Visit>
  void for_members(std::size_t v, const Visit& visit) const {
    std::size_t i = begin_of(v);
    const auto at_place = [&](auto place) {
      for (const std::size_t end = end_[places * v + place]; i < end; ++i) visit(place, i);
    };
    [&]<std::size_t... place>(std::index_sequence<place...>) {
      (at_place(std::integral_constant<std::size_t, place>()), ...);
    }(std::make_index_sequence<places>());
  }

  // Members by their blocks.
  void gather(std::span<const Cell> cells) {
    const std::size_t grain = std::max(least_piece, cells.size() >> 11);
    std::vector<std::vector<std::uint32_t>> counts(base::piece_count(cells.size(), grain));
    std::vector<std::vector<std::uint32_t>> sides(counts.size());
    const auto in_pieces = [&](const auto& visit) {
      base::for_pieces(cells.size(), grain, threads_, passes_.next(),
                       [&](std::size_t piece, std::size_t begin, std::size_t end) {
                         counts[piece].resize(blocks()), sides[piece].resize(blocks());
                         for (std::size_t t = begin; t < end; ++t) {
                           for (std::size_t place = 0; place < places; ++place) visit(piece, t, place);
                         }
                       });
    };
    const auto block_of = [&](std::size_t t, std::size_t place) {
      return at(cells[t][order_[t][place]]) >> shift_;
    };
    in_pieces([&](std::size_t piece, std::size_t t, std::size_t place) {
      if (place == 0) order_[t] = Order(cells[t]);
      const std::size_t block = block_of(t, place);
      ++counts[piece][block];
      sides[piece][block] += static_cast<std::uint32_t>(places - place);
    });
    std::size_t sum = 0, side_sum = 0;
    for (std::size_t block = 0; block < blocks(); ++block) {
      block_start_[block] = sum, side_start_[block] = side_sum;
      for (auto& count : counts) sum += std::exchange(count[block], static_cast<std::uint32_t>(sum));
      for (const auto& side : sides) side_sum += side[block];
    }
    block_start_.back() = sum, side_start_.back() = side_sum;
    members_ = LargeArray<std::uint32_t>(sum);
    in_pieces([&](std::size_t piece, std::size_t t, std::size_t place) {
      members_[counts[piece][block_of(t, place)]++] = static_cast<std::uint32_t>(4 * t + place);
    });
  }

  // By their vertices and places.
  void sort_block(std::span<const Cell> cells, std::size_t block) {
    const std::size_t first = first_of(block), count = places * (first_of(block + 1) - first);
    const std::vector<std::uint32_t> given(members_.data() + block_start_[block],
                                           members_.data() + block_start_[block + 1]);
    std::vector<std::uint32_t> group(given.size()), ends(count + 1);
    for (std::size_t i = 0; i < given.size(); ++i) {
      const std::size_t t = given[i] / 4, place = given[i] % 4;
      group[i] = static_cast<std::uint32_t>(places * (at(cells[t][order_[t][place]]) - first) + place);
      ++ends[group[i] + 1];
    }
    ends[0] = static_cast<std::uint32_t>(block_start_[block]);
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    for (std::size_t i = 0; i < given.size(); ++i) members_[ends[group[i]]++] = given[i];
    std::copy_n(ends.begin(), count, end_.begin() + static_cast<std::ptrdiff_t>(places * first));
  }

  template <class Cut>
  void gather_sides(std::size_t v, std::span<const Cell> cells, const Cut& cut, VertexEdges& edges) const {
    edges.reset(places * (end_[places * v + places - 1] - begin_of(v)));
    for_members(v, [&](auto place, std::size_t i) {
      const std::size_t t = members_[i] / 4;
      const Order order = order_[t];
      __builtin_prefetch(&cells[later_member(i, v) / 4]);
      const unsigned cut_sides = cut(t);
      for (std::size_t later = place + 1; later < width; ++later) {
        const std::size_t k = order[place], l = order[later];
        edges.add(cells[t][l], cut_sides >> side_between[k][l] & 1U);
      }
    });
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
  base::Passes& passes_;                   // of which gathering takes two, finding two, and a visit one
  int shift_;                              // a block has so many bits of vertices
  std::vector<std::size_t> block_start_;   // of members
  LargeArray<Order> order_;                // [t]
  LargeArray<std::uint32_t> members_;      // 4 t + place by blocks, then by vertices and places
  std::vector<std::uint32_t> end_;         // [vertices][places] of their members
  std::vector<std::size_t> side_start_;    // of blocks
  LargeArray<std::uint8_t> edge_;          // [sides] of members, in their order: which one of the vertex
  std::vector<std::uint32_t> edge_start_;  // [vertices + 1]
};

}  // namespace vorotool::core::tetrahedral_alpha
