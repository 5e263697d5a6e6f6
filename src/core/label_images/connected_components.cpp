#include "core/label_images/connected_components.hpp"

#include <algorithm>
#include <vector>

#include "core/label_images/streaming_components.hpp"

namespace vorotool::core::label_images {

std::uint32_t label_components(std::span<const std::uint8_t> mask, std::size_t width,
                               Connectivity connectivity, std::span<std::uint32_t> numbers,
                               const base::Monitor& monitor) {
  if (mask.empty()) return 0;
  StreamingComponents components(width, connectivity);
  components.add(mask, numbers, monitor);
  std::vector<std::uint32_t> number(std::size_t{components.size()} + 1);
  const std::uint32_t count = components.settle(number);
  const std::size_t piece = rows_per_piece(width) * width;
  for (std::size_t start = 0; start < mask.size(); start += piece) {
    base::report(monitor, 1);
    for (std::uint32_t& each : numbers.subspan(start, std::min(piece, mask.size() - start)))
      each = number[each];
  }
  return count;
}

}  // namespace vorotool::core::label_images
