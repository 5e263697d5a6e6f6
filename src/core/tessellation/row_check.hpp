// The exact check of one row of pixels or voxels against a tree of the seeds.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/numbers/int128.hpp"
#include "core/spatial/kd_tree.hpp"

namespace vorotool::core::tessellation {

// Checks rows that run along the first axis. The labels that are checked say only where to look, and which
// seed is likely: whatever they are, each pixel's right label is known by the end.
template <class Distance, std::size_t Axes>
class RowCheck {
 public:
  using Tree = spatial::KdTree<std::int64_t, Distance, Axes>;
  using Nearest = typename Tree::Nearest;
  using Place = typename Tree::Place;

  // Pixels are `side` steps wide.
  RowCheck(const Tree& tree, std::int64_t side, std::optional<numbers::uint128> limit)
      : tree_(tree), side_(side), limit_(limit), likely_(likely_size, 0) {}

  // Calls wrong(column, right label) for each wrong pixel, in no order. `first` is the place of the row's first
  // pixel.
  template <class Label, class Wrong>
  void check(std::span<const Label> row, const Place& first, const Wrong& wrong) {
    first_ = first;
    std::ptrdiff_t last = 0;  // in the tree: of the pixel before
    for (std::size_t begin = 0; begin < row.size();) {
      const std::size_t end = run_end(row, begin);
      if (tree_.size() == 0) {
        compare(row, begin, end, 0, wrong);
      } else {
        last = check_run(row, begin, end - 1, last, wrong);
      }
      begin = end;
    }
  }

 private:
  static constexpr std::size_t likely_size = std::size_t{1} << 12;

  Place at(std::size_t column) const {
    Place place = first_;
    place[0] += side_ * static_cast<std::int64_t>(column);
    return place;
  }

  template <class Label>
  static std::size_t run_end(std::span<const Label> row, std::size_t begin) {
    std::size_t end = begin + 1;
    while (end < row.size() && row[end] == row[begin]) ++end;
    return end;
  }

  // The pixels begin ... end, all of one label; gives where the last one's seed is in the tree.
  template <class Label, class Wrong>
  std::ptrdiff_t check_run(std::span<const Label> row, std::size_t begin, std::size_t end,
                           std::ptrdiff_t before, const Wrong& wrong) {
    std::ptrdiff_t& likely = likely_[row[begin] % likely_size];
    const Nearest at_begin = query(begin, before, likely);
    compare(row, begin, begin + 1, label_of(at_begin), wrong);
    Nearest at_end = at_begin;
    if (end > begin) {
      at_end = query(end, at_begin.place, likely);
      compare(row, end, end + 1, label_of(at_end), wrong);
      check_between(row, begin, at_begin, end, at_end, wrong);
    }
    likely = at_end.place;
    return at_end.place;
  }

  // A query that starts from the better of two seeds.
  Nearest query(std::size_t column, std::ptrdiff_t one, std::ptrdiff_t other) const {
    const Place place = at(column);
    Nearest best = tree_.bound(one, place);
    const Nearest second = tree_.bound(other, place);
    if (second.d2 < best.d2 || (second.d2 == best.d2 && second.label < best.label)) best = second;
    return tree_.nearest(place, best);
  }

  std::uint32_t label_of(const Nearest& nearest) const {
    return limit_ && nearest.d2 > *limit_ ? 0 : nearest.label;
  }

  // Pixels strictly between two known ones. Along a row the difference of the squared distances to two seeds is
  // linear, so the pixels where one seed comes before another, in (d2, label), are a half-line, and those where
  // it comes before all are an interval: the seed that is right at both ends is right between them. One squared
  // distance is convex: what is within the limit at both ends is so between them.
  template <class Label, class Wrong>
  void check_between(std::span<const Label> row, std::size_t begin, const Nearest& at_begin, std::size_t end,
                     const Nearest& at_end, const Wrong& wrong) {
    if (end - begin < 2) return;
    if (at_begin.place == at_end.place) {
      if (!limit_ || (at_begin.d2 <= *limit_ && at_end.d2 <= *limit_)) {
        compare(row, begin + 1, end, at_begin.label, wrong);
        return;
      }
      for (std::size_t column = begin + 1; column < end; ++column)
        compare(row, column, column + 1, label_of(tree_.bound(at_begin.place, at(column))), wrong);
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    const Nearest at_middle = query(middle, at_begin.place, at_end.place);
    compare(row, middle, middle + 1, label_of(at_middle), wrong);
    check_between(row, begin, at_begin, middle, at_middle, wrong);
    check_between(row, middle, at_middle, end, at_end, wrong);
  }

  template <class Label, class Wrong>
  static void compare(std::span<const Label> row, std::size_t begin, std::size_t end, std::uint32_t right,
                      const Wrong& wrong) {
    for (std::size_t column = begin; column < end; ++column) {
      if (row[column] != right) wrong(column, right);
    }
  }

  const Tree& tree_;
  std::int64_t side_;
  std::optional<numbers::uint128> limit_;
  // In the tree, the seed of the latest run of a label, by the label's last bits: any seed is a bound.
  std::vector<std::ptrdiff_t> likely_;
  Place first_{};
};

struct Extent {
  std::int64_t low;
  std::int64_t high;
};

// Of the seeds and of the pixels along one axis, of which seeds are in steps. Throws std::out_of_range beyond
// lattice_limit.
Extent lattice_extent(std::span<const std::int64_t> seeds, std::int64_t origin, std::size_t size,
                      std::int64_t side);

// Whether squared distances within these extents fit 64 bits: see KdTree.
template <class... Extents>
bool is_narrow(const Extents&... extents) {
  constexpr std::int64_t narrow = std::int64_t{1} << 31;
  return ((extents.high - extents.low <= narrow) && ...);
}

}  // namespace vorotool::core::tessellation
