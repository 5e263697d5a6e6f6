#include "core/tessellation/verify_tessellation.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/tessellation/row_check.hpp"

namespace vorotool::core::tessellation {

using base::Monitor;
using numbers::uint128;

namespace {

template <class Distance, class Label>
WrongPixels verify(std::span<const Label> image, const PixelFrame& frame, const LatticeSeeds& seeds,
                   std::optional<uint128> limit, unsigned threads, const Monitor& monitor) {
  const spatial::KdTree<std::int64_t, Distance> tree({seeds.x, seeds.y}, seeds.labels, monitor);
  // At a query a pixel, 2^14 pixels are a few milliseconds.
  const std::size_t rows = std::max<std::size_t>(1, (std::size_t{1} << 14) / frame.width);
  std::vector<WrongPixels> wrong(base::piece_count(frame.height, rows));
  const auto check = [&](std::size_t piece, std::size_t begin, std::size_t end) {
    RowCheck<Distance, 2> rows_of(tree, seeds.pixel.x, limit);
    for (std::size_t y = begin; y < end; ++y) {
      const auto row = image.subspan(y * frame.width, frame.width);
      const auto note = [&](std::size_t x, std::uint32_t right) {
        WrongPixels& found = wrong[piece];
        const std::uint64_t count = found.count + 1;
        if (count == 1 || (found.row == y && x < found.column)) found = {count, x, y, row[x], right};
        found.count = count;
      };
      const std::int64_t row_y = seeds.pixel.y * (frame.y + static_cast<std::int64_t>(y));
      rows_of.check(row, {seeds.pixel.x * frame.x, row_y}, note);
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

}  // namespace

Extent lattice_extent(std::span<const std::int64_t> seeds, std::int64_t origin, std::size_t size,
                      std::int64_t side) {
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

template <class Label>
WrongPixels verify_tessellation(std::span<const Label> image, const PixelFrame& frame,
                                const LatticeSeeds& seeds, std::optional<uint128> limit, unsigned threads,
                                const Monitor& monitor) {
  if (image.empty()) return {};
  const Extent x = lattice_extent(seeds.x, frame.x, frame.width, seeds.pixel.x);
  const Extent y = lattice_extent(seeds.y, frame.y, frame.height, seeds.pixel.y);
  if (is_narrow(x, y)) {
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
