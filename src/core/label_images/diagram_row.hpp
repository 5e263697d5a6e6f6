// One row of the digital Voronoi diagram, of an image or of a volume.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace vorotool::core::label_images {

// Writes 1 where a label is not 0 and one beside it, or at its place in a row of `others`, is larger; else 0.
// Plain comparisons without branches: the compiler makes vectors of them.
template <class Label, std::size_t Others>
void mark_row(const Label* __restrict row, const std::array<const Label*, Others>& others, std::size_t width,
              std::uint8_t* __restrict out) {
  auto mark = [&](std::size_t x, Label left, Label right) {
    Label largest = std::max(left, right);
    for (std::size_t k = 0; k < Others; ++k) largest = std::max(largest, others[k][x]);
    out[x] = static_cast<std::uint8_t>((row[x] != 0) & (row[x] < largest));
  };
  mark(0, row[0], row[width > 1 ? 1 : 0]);
  for (std::size_t x = 1; x + 1 < width; ++x) mark(x, row[x - 1], row[x + 1]);
  if (width > 1) mark(width - 1, row[width - 2], row[width - 1]);
}

}  // namespace vorotool::core::label_images
