#include "core/delaunay/spatial_sort.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>

#include "core/base/parallel.hpp"
#include "core/base/radix_sort.hpp"

namespace vorotool::core::delaunay {

using base::Monitor;
using kernel::Point;
using spatial::Bounds;
using spatial::MortonGrid;

namespace {

constexpr std::size_t words_a_piece = std::size_t{1} << 14;
constexpr std::size_t ahead = 32;  // words: how early points are called for

// A word holds the code of a point above its index.
std::uint32_t code_of(std::uint64_t word) { return static_cast<std::uint32_t>(word >> 32); }
std::uint32_t index_of(std::uint64_t word) { return static_cast<std::uint32_t>(word); }

bool same_place(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }

class Orderer {
 public:
  Orderer(std::span<const Point> points, std::span<std::int32_t> first, FineOrder fine, unsigned threads,
          const Monitor& monitor, const std::optional<Bounds>& within)
      : points_(points), first_(first), fine_(fine), threads_(threads), monitor_(monitor), within_(within) {}

  MortonOrder run() {
    const std::size_t count = points_.size();
    std::vector<std::uint64_t> words(count);
    for (std::size_t i = 0; i < count; ++i) words[i] = i;
    if (count > 0) {
      const MortonGrid grid = within_ ? MortonGrid(*within_) : grid_of(words);
      sort_by(words, [&grid](const Point& p) { return grid.code(p); });
      if (fine_ == FineOrder::of_places) whole_ = grid;
    }
    order_.vertices = base::LargeArray<RingVertex>(count);
    order_.index.resize(count);
    order_.code.resize(count);
    repeated_.resize(count);
    crowds_.resize(base::piece_count(count, words_a_piece));
    base::parallel_for(
        crowds_.size(), threads_, [&](std::size_t piece) { put_cells(words, piece); }, monitor_);
    put_crowds(words);
    if (any_repeated_) drop_repeated();
    return std::move(order_);
  }

 private:
  struct Range {
    std::size_t begin, end;
  };

  // A grid over the points of some words.
  MortonGrid grid_of(std::span<const std::uint64_t> words) const {
    Bounds bounds(points_[index_of(words[0])]);
    for (const std::uint64_t word : words) bounds.add(points_[index_of(word)]);
    return MortonGrid(bounds);
  }

  // Gives words the codes of their points, and sorts them by these and then by index.
  template <class Code>
  void sort_by(std::vector<std::uint64_t>& words, Code code) const {
    for (std::uint64_t& word : words) {
      const std::uint32_t index = index_of(word);
      word = std::uint64_t{code(points_[index])} << 32 | index;
    }
    if (words.size() < 4096) {
      std::sort(words.begin(), words.end());
    } else {
      base::radix_sort(words, 32, 32 + 2 * spatial::morton_cell_bits);
    }
  }

  // Calls visit(range) for the cells that begin in a range of sorted words.
  template <class Visit>
  static void for_cells(std::span<const std::uint64_t> words, Range within, Visit visit) {
    std::size_t begin = within.begin;
    while (begin > 0 && begin < within.end && code_of(words[begin]) == code_of(words[begin - 1])) ++begin;
    while (begin < within.end) {
      std::size_t end = begin + 1;
      while (end < words.size() && code_of(words[end]) == code_of(words[begin])) ++end;
      visit(Range{begin, end});
      begin = end;
    }
  }

  void put_cells(std::vector<std::uint64_t>& words, std::size_t piece) {
    const Range within{piece * words_a_piece, std::min(words.size(), (piece + 1) * words_a_piece)};
    for_cells(words, within, [&](Range cell) {
      if (cell.begin + ahead < words.size())
        __builtin_prefetch(&points_[index_of(words[cell.begin + ahead])]);
      std::fill(order_.code.begin() + offset(cell.begin), order_.code.begin() + offset(cell.end),
                code_of(words[cell.begin]));
      if (cell.end - cell.begin > (whole_ ? 1 : spatial::morton_crowd)) {
        crowds_[piece].push_back(cell);
      } else {
        put_cell(std::span(words).subspan(cell.begin, cell.end - cell.begin), cell.begin);
      }
    });
  }

  void put_crowds(const std::vector<std::uint64_t>& words) {
    std::vector<Range> crowds;
    for (const std::vector<Range>& some : crowds_) crowds.insert(crowds.end(), some.begin(), some.end());
    if (crowds.empty()) return;
    order_.fine.resize(words.size());
    const auto put = [&](std::size_t k) {
      const auto [begin, end] = crowds[k];
      std::vector<std::uint64_t> finer(words.begin() + offset(begin), words.begin() + offset(end));
      if (whole_) {
        sort_by(finer, [this](const Point& p) { return whole_->fine_code(p); });
      } else {
        const MortonGrid grid = grid_of(finer);
        sort_by(finer, [&grid](const Point& p) { return grid.code(p); });
      }
      for_cells(finer, {0, finer.size()}, [&, begin = begin](Range cell) {
        std::fill(order_.fine.begin() + offset(begin + cell.begin),
                  order_.fine.begin() + offset(begin + cell.end), code_of(finer[cell.begin]));
        put_cell(std::span(finer).subspan(cell.begin, cell.end - cell.begin), begin + cell.begin);
      });
    };
    base::parallel_for(crowds.size(), threads_, put, monitor_);
  }

  // Puts the points of a cell in their places, from `place` on, sorted by (x, y) and then index.
  void put_cell(std::span<std::uint64_t> cell, std::size_t place) {
    if (cell.size() > 1) {
      std::sort(cell.begin(), cell.end(), [&](std::uint64_t a, std::uint64_t b) {
        const Point& p = points_[index_of(a)];
        const Point& q = points_[index_of(b)];
        if (p.x != q.x) return p.x < q.x;
        return p.y != q.y ? p.y < q.y : a < b;
      });
    }
    std::size_t original = place;
    for (std::size_t i = 0; i < cell.size(); ++i) {
      const std::size_t here = place + i;
      order_.index[here] = index_of(cell[i]);
      order_.vertices[here].clear(points_[index_of(cell[i])]);
      const bool repeated = i > 0 && same_place(order_.vertices[here].point, order_.vertices[original].point);
      if (repeated) any_repeated_.store(true, std::memory_order_relaxed);
      if (!repeated) original = here;
      repeated_[here] = repeated;
      first_[index_of(cell[i])] = static_cast<std::int32_t>(order_.index[original]);
    }
  }

  void drop_repeated() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < repeated_.size(); ++i) {
      if (repeated_[i]) continue;
      order_.vertices[kept] = order_.vertices[i];
      order_.index[kept] = order_.index[i];
      order_.code[kept] = order_.code[i];
      if (!order_.fine.empty()) order_.fine[kept] = order_.fine[i];
      ++kept;
    }
    order_.index.resize(kept);
    order_.code.resize(kept);
    if (!order_.fine.empty()) order_.fine.resize(kept);
  }

  static std::ptrdiff_t offset(std::size_t i) { return static_cast<std::ptrdiff_t>(i); }

  std::span<const Point> points_;
  std::span<std::int32_t> first_;
  FineOrder fine_;
  unsigned threads_;
  const Monitor& monitor_;
  const std::optional<Bounds>& within_;
  std::optional<MortonGrid> whole_;  // over all points, where cells have a finer one in themselves
  MortonOrder order_;
  std::vector<std::uint8_t> repeated_;      // [points in order] whether the one before is at the same place
  std::vector<std::vector<Range>> crowds_;  // [pieces] the cells with many points that begin there
  std::atomic<bool> any_repeated_{false};
};

}  // namespace

MortonOrder morton_order(std::span<const Point> points, std::span<std::int32_t> first, FineOrder fine,
                         unsigned threads, const Monitor& monitor, const std::optional<Bounds>& within) {
  return Orderer(points, first, fine, threads, monitor, within).run();
}

}  // namespace vorotool::core::delaunay
