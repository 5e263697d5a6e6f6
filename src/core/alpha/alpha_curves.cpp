#include "core/alpha/alpha_curves.hpp"

#include <algorithm>
#include <vector>

#include "core/base/disjoint_sets.hpp"
#include "core/base/groups.hpp"
#include "core/numbers/long_sum.hpp"

namespace vorotool::core::alpha {

using base::at;
using base::DisjointSets;
using base::LargeArray;
using base::Monitor;
using numbers::LongSum;

namespace {

// Numbers below `count` by their ranks, of which the last is that of what never comes.
template <class RankOf>
base::Groups<std::uint32_t> by_rank(std::size_t count, std::size_t ranks, const RankOf& rank) {
  return {ranks + 1, [&](const auto& add) {
            for (std::size_t i = 0; i < count; ++i) add(rank(i), static_cast<std::uint32_t>(i));
          }};
}

class Sweep {
 public:
  Sweep(const CurveInput& input, const Monitor& monitor)
      : in_(input),
        m_(input.spectrum),
        monitor_(monitor),
        out_{LargeArray<double>(m_), LargeArray<double>(m_), LargeArray<std::int32_t>(m_),
             LargeArray<std::int32_t>(m_)},
        arrivals_(m_ + 1) {
    for (const std::int32_t rank : in_.cell_rank) ++arrivals_[at(rank)];
  }

  Curves run() {
    measure();
    count_regions();
    count_cavities();
    return std::move(out_);
  }

 private:
  std::int32_t rank_of(std::int32_t cell) const {
    return cell < 0 ? static_cast<std::int32_t>(m_) : in_.cell_rank[at(cell)];
  }

  void measure() {
    std::vector<LongSum> content(m_ + 1), border(m_ + 1);
    for (std::size_t c = 0; c < in_.cell_size.size(); ++c)
      content[at(in_.cell_rank[c])].add(in_.cell_size[c]);
    for (std::size_t w = 0; w < in_.sides.size(); ++w) {
      const auto [low, high] = std::minmax({rank_of(in_.sides[w][0]), rank_of(in_.sides[w][1])});
      border[at(low)].add(in_.wall_size[w]);
      border[at(high)].add(-in_.wall_size[w]);
    }
    LongSum contents, borders;
    for (std::size_t k = 0; k < m_; ++k) {
      base::report_item(monitor_, k, 3 * m_);
      contents.add(content[k]);
      borders.add(border[k]);
      out_.content[k] = contents.value.head;
      out_.border[k] = borders.value.head;
    }
  }

  // What is on both sides of a wall: 0 is all outside, c + 1 a cell.
  bool join(DisjointSets<>& cells, std::size_t wall) const {
    const auto& [a, b] = in_.sides[wall];
    return cells.join(static_cast<std::uint32_t>(a + 1), static_cast<std::uint32_t>(b + 1));
  }

  // Upwards: a cell is a new region, and a wall that goes inside may join two.
  void count_regions() {
    const auto walls = by_rank(in_.sides.size(), m_, [&](std::size_t w) {
      return std::max(rank_of(in_.sides[w][0]), rank_of(in_.sides[w][1]));
    });
    DisjointSets cells(in_.cell_rank.size() + 1);
    std::int32_t regions = 0;
    for (std::size_t k = 0; k < m_; ++k) {
      base::report_item(monitor_, m_ + k, 3 * m_);
      regions += arrivals_[k];
      for (const std::uint32_t w : walls[k]) regions -= join(cells, w);
      out_.regions[k] = regions;
    }
  }

  // Downwards: a cell that leaves is a new cavity, and a wall that leaves joins what is on both its sides; what is
  // outside counts for nothing.
  void count_cavities() {
    const auto walls = by_rank(in_.sides.size(), m_, [&](std::size_t w) { return in_.wall_rank[w]; });
    DisjointSets cells(in_.cell_rank.size() + 1);
    std::int32_t cavities = 0;
    for (std::size_t k = m_; k-- > 0;) {
      base::report_item(monitor_, 3 * m_ - k, 3 * m_);
      cavities += arrivals_[k + 1];
      for (const std::uint32_t w : walls[k + 1]) cavities -= join(cells, w);
      out_.cavities[k] = cavities;
    }
  }

  const CurveInput& in_;
  std::size_t m_;
  const Monitor& monitor_;
  Curves out_;
  std::vector<std::int32_t> arrivals_;  // [spectrum + 1] cells of each rank
};

}  // namespace

Curves alpha_curves(const CurveInput& input, const Monitor& monitor) { return Sweep(input, monitor).run(); }

LargeArray<std::int32_t> part_counts(std::size_t spectrum, std::size_t points,
                                     std::span<const base::IndexPair> edges,
                                     std::span<const std::int32_t> edge_rank, const Monitor& monitor) {
  const auto ranked = by_rank(edges.size(), spectrum, [&](std::size_t e) { return edge_rank[e]; });
  std::int32_t last = -1;
  for (const auto& [a, b] : edges) last = std::max({last, a, b});
  DisjointSets sets(at(last + 1));
  LargeArray<std::int32_t> counts(spectrum);
  auto parts = static_cast<std::int32_t>(points);
  for (std::size_t k = 0; k < spectrum; ++k) {
    base::report_item(monitor, k, spectrum);
    for (const std::uint32_t e : ranked[k])
      parts -= sets.join(static_cast<std::uint32_t>(edges[e][0]), static_cast<std::uint32_t>(edges[e][1]));
    counts[k] = parts;
  }
  return counts;
}

}  // namespace vorotool::core::alpha
