#include "core/label_images/digital_diagram.hpp"

#include <stdexcept>

#include "core/base/parallel.hpp"
#include "core/label_images/diagram_row.hpp"
#include "core/label_images/label_runs.hpp"

namespace vorotool::core::label_images {

using base::Monitor;

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
    mark_row<Label, 2>(row, {up, down}, width, diagram.data() + y * width);
  });
}

template void mark_diagram(std::span<const std::uint8_t>, std::size_t, std::span<const std::uint8_t>,
                           std::span<const std::uint8_t>, std::span<std::uint8_t>, unsigned, const Monitor&);
template void mark_diagram(std::span<const std::uint16_t>, std::size_t, std::span<const std::uint16_t>,
                           std::span<const std::uint16_t>, std::span<std::uint8_t>, unsigned, const Monitor&);
template void mark_diagram(std::span<const std::uint32_t>, std::size_t, std::span<const std::uint32_t>,
                           std::span<const std::uint32_t>, std::span<std::uint8_t>, unsigned, const Monitor&);

}  // namespace vorotool::core::label_images
