#include "core/volumes/volume_diagram.hpp"

#include <stdexcept>

#include "core/base/parallel.hpp"
#include "core/label_images/diagram_row.hpp"
#include "core/label_images/label_runs.hpp"

namespace vorotool::core::volumes {

using base::Monitor;

template <class Label>
void mark_diagram(std::span<const Label> labels, std::size_t width, std::size_t height,
                  std::span<const Label> before, std::span<const Label> after,
                  std::span<std::uint8_t> diagram, unsigned threads, const Monitor& monitor) {
  if (labels.empty()) return;
  const std::size_t slice = width * height;
  if (diagram.size() != labels.size() || (!before.empty() && before.size() != slice) ||
      (!after.empty() && after.size() != slice)) {
    throw std::length_error("the slices of a diagram differ in size");
  }
  const std::size_t depth = labels.size() / slice;
  const auto mark = [&](std::size_t k) {
    const std::size_t y = k % height, z = k / height;
    const Label* row = labels.data() + k * width;
    // Outside the volume stands the row itself: nothing is larger than itself.
    const Label* up = y > 0 ? row - width : row;
    const Label* down = y + 1 < height ? row + width : row;
    const Label* front = z > 0 ? row - slice : before.empty() ? row : before.data() + y * width;
    const Label* back = z + 1 < depth ? row + slice : after.empty() ? row : after.data() + y * width;
    label_images::mark_row<Label, 4>(row, {up, down, front, back}, width, diagram.data() + k * width);
  };
  base::for_items(height * depth, label_images::rows_per_piece(width), threads, monitor, mark);
}

#define VOROTOOL_INSTANTIATE(Label)                                                                    \
  template void mark_diagram(std::span<const Label>, std::size_t, std::size_t, std::span<const Label>, \
                             std::span<const Label>, std::span<std::uint8_t>, unsigned, const Monitor&);
VOROTOOL_INSTANTIATE(std::uint8_t)
VOROTOOL_INSTANTIATE(std::uint16_t)
VOROTOOL_INSTANTIATE(std::uint32_t)
#undef VOROTOOL_INSTANTIATE

}  // namespace vorotool::core::volumes
