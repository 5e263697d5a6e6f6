#include "core/label_images/digital_diagram.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/base/parallel.hpp"
#include "core/label_images/label_runs.hpp"

namespace vorotool::core::label_images {

using base::Monitor;

namespace {

// Plain comparisons without branches: the compiler makes vectors of them.
template <class Label>
void mark_row(const Label* __restrict row, const Label* above, const Label* below, std::size_t width,
              std::uint8_t* __restrict out) {
  auto mark = [&](std::size_t x, Label left, Label right) {
    const Label largest = std::max(std::max(left, right), std::max(above[x], below[x]));
    out[x] = static_cast<std::uint8_t>((row[x] != 0) & (row[x] < largest));
  };
  mark(0, row[0], row[width > 1 ? 1 : 0]);
  for (std::size_t x = 1; x + 1 < width; ++x) mark(x, row[x - 1], row[x + 1]);
  if (width > 1) mark(width - 1, row[width - 2], row[width - 1]);
}

}  // namespace

template <class Label>
void mark_diagram(std::span<const Label> labels, std::size_t width, std::span<const Label> above,
                  std::span<const Label> below, std::span<std::uint8_t> diagram, unsigned threads,
                  const Monitor& monitor) {
  if (labels.empty()) return;
  if (diagram.size() != labels.size() || (!above.empty() && above.size() != width) ||
      (!below.empty() && below.size() != width)) {
    throw std::length_error("the rows of a diagram differ in width");
  }
  const std::size_t height = labels.size() / width;
  base::for_items(height, rows_per_piece(width), threads, monitor, [&](std::size_t y) {
    const Label* row = labels.data() + y * width;
    // Outside the image stands the row itself: nothing is larger than itself.
    const Label* up = y > 0 ? row - width : above.empty() ? row : above.data();
    const Label* down = y + 1 < height ? row + width : below.empty() ? row : below.data();
    mark_row(row, up, down, width, diagram.data() + y * width);
  });
}

template void mark_diagram(std::span<const std::uint8_t>, std::size_t, std::span<const std::uint8_t>,
                           std::span<const std::uint8_t>, std::span<std::uint8_t>, unsigned, const Monitor&);
template void mark_diagram(std::span<const std::uint16_t>, std::size_t, std::span<const std::uint16_t>,
                           std::span<const std::uint16_t>, std::span<std::uint8_t>, unsigned, const Monitor&);
template void mark_diagram(std::span<const std::uint32_t>, std::size_t, std::span<const std::uint32_t>,
                           std::span<const std::uint32_t>, std::span<std::uint8_t>, unsigned, const Monitor&);

}  // namespace vorotool::core::label_images
