#include "core/tessellation/verify_tessellation.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "core/base/parallel.hpp"

namespace vorotool::core::tessellation {

using base::Monitor;
using numbers::uint128;

namespace {

// The right labels of one row after the other, from a tree of the seeds.
template <class Distance>
class RightRow {
 public:
  using Tree = spatial::KdTree<std::int64_t, Distance>;
  using Nearest = typename Tree::Nearest;

  RightRow(const Tree& tree, const PixelFrame& frame, PixelSides pixel, std::optional<uint128> limit)
      : tree_(tree), frame_(frame), pixel_(pixel), limit_(limit), labels_(frame.width, 0) {}

  const std::vector<std::uint32_t>& compute(std::size_t row) {
    if (tree_.size() == 0) return labels_;
    y_ = pixel_.y * (frame_.y + static_cast<std::int64_t>(row));
    const std::size_t last = frame_.width - 1;
    const Nearest begin = tree_.nearest(x(0), y_);
    put(0, begin);
    if (last == 0) return labels_;
    const Nearest end = query(last, begin, begin);
    put(last, end);
    fill(0, begin, last, end);
    return labels_;
  }

 private:
  std::int64_t x(std::size_t column) const {
    return pixel_.x * (frame_.x + static_cast<std::int64_t>(column));
  }

  // A query that starts from the better of two neighbouring answers.
  Nearest query(std::size_t column, const Nearest& one, const Nearest& other) const {
    Nearest best = tree_.bound(one.place, x(column), y_);
    const Nearest second = tree_.bound(other.place, x(column), y_);
    if (second.d2 < best.d2 || (second.d2 == best.d2 && second.label < best.label)) best = second;
    return tree_.nearest(x(column), y_, best);
  }

  void put(std::size_t column, const Nearest& nearest) {
    labels_[column] = limit_ && nearest.d2 > *limit_ ? 0 : nearest.label;
  }

  // Labels of the pixels strictly between two known ones. Along a row the difference of the squared distances
  // to two seeds is linear, so the pixels where one seed comes before another, in (d2, label), are a
  // half-line, and those where it comes before all are an interval: the seed that is right at both ends is
  // right between them.
  void fill(std::size_t begin, const Nearest& at_begin, std::size_t end, const Nearest& at_end) {
    if (end - begin < 2) return;
    if (at_begin.place == at_end.place) {
      for (std::size_t column = begin + 1; column < end; ++column)
        put(column, tree_.bound(at_begin.place, x(column), y_));
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    const Nearest at_middle = query(middle, at_begin, at_end);
    put(middle, at_middle);
    fill(begin, at_begin, middle, at_middle);
    fill(middle, at_middle, end, at_end);
  }

  const Tree& tree_;
  const PixelFrame& frame_;
  PixelSides pixel_;
  std::optional<uint128> limit_;
  std::int64_t y_ = 0;
  std::vector<std::uint32_t> labels_;
};

template <class Label>
void compare_row(std::span<const Label> row, std::span<const std::uint32_t> right, std::size_t y,
                 WrongPixels& wrong) {
  for (std::size_t x = 0; x < row.size(); ++x) {
    if (row[x] == right[x]) continue;
    if (wrong.count++ == 0) wrong = {1, x, y, row[x], right[x]};
  }
}

template <class Distance, class Label>
WrongPixels verify(std::span<const Label> image, const PixelFrame& frame, const LatticeSeeds& seeds,
                   std::optional<uint128> limit, unsigned threads, const Monitor& monitor) {
  const spatial::KdTree<std::int64_t, Distance> tree(seeds.x, seeds.y, seeds.labels, monitor);
  // At a query a pixel, 2^14 pixels are a few milliseconds.
  const std::size_t rows = std::max<std::size_t>(1, (std::size_t{1} << 14) / frame.width);
  std::vector<WrongPixels> wrong(base::piece_count(frame.height, rows));
  const auto check = [&](std::size_t piece, std::size_t begin, std::size_t end) {
    RightRow<Distance> right(tree, frame, seeds.pixel, limit);
    for (std::size_t y = begin; y < end; ++y) {
      compare_row(image.subspan(y * frame.width, frame.width), std::span(right.compute(y)), y, wrong[piece]);
    }
  };
  base::for_pieces(frame.height, rows, threads, monitor, check);
  WrongPixels all;
  for (const WrongPixels& piece : wrong) {
    const std::uint64_t count = all.count + piece.count;
    if (all.count == 0) all = piece;
    all.count = count;
  }
  return all;
}

struct Extent {
  std::int64_t low;
  std::int64_t high;
};

// Of the seeds and of the pixels along one axis.
Extent extent(std::span<const std::int64_t> seeds, std::int64_t origin, std::size_t size, std::int64_t side) {
  const std::int64_t most = lattice_limit / side;
  if (origin < -most || origin > most || size > static_cast<std::size_t>(most - origin) + 1) {
    throw std::out_of_range("the frame reaches beyond 2^40 lattice steps");
  }
  Extent all{side * origin, side * (origin + static_cast<std::int64_t>(size) - 1)};
  for (const std::int64_t coordinate : seeds) {
    all.low = std::min(all.low, coordinate);
    all.high = std::max(all.high, coordinate);
  }
  if (all.low < -lattice_limit || all.high > lattice_limit) {
    throw std::out_of_range("a seed lies beyond 2^40 lattice steps");
  }
  return all;
}

}  // namespace

template <class Label>
WrongPixels verify_tessellation(std::span<const Label> image, const PixelFrame& frame,
                                const LatticeSeeds& seeds, std::optional<uint128> limit, unsigned threads,
                                const Monitor& monitor) {
  if (image.empty()) return {};
  const Extent x = extent(seeds.x, frame.x, frame.width, seeds.pixel.x);
  const Extent y = extent(seeds.y, frame.y, frame.height, seeds.pixel.y);
  constexpr std::int64_t narrow = std::int64_t{1} << 31;  // see KdTree
  if (x.high - x.low <= narrow && y.high - y.low <= narrow) {
    return verify<std::uint64_t>(image, frame, seeds, limit, threads, monitor);
  }
  return verify<uint128>(image, frame, seeds, limit, threads, monitor);
}

#define VOROTOOL_INSTANTIATE(Label)                                                                        \
  template WrongPixels verify_tessellation(std::span<const Label>, const PixelFrame&, const LatticeSeeds&, \
                                           std::optional<uint128>, unsigned, const Monitor&);
VOROTOOL_INSTANTIATE(std::uint8_t)
VOROTOOL_INSTANTIATE(std::uint16_t)
VOROTOOL_INSTANTIATE(std::uint32_t)
#undef VOROTOOL_INSTANTIATE

}  // namespace vorotool::core::tessellation
