// The digital Voronoi diagram of section 2.1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/monitor.hpp"

namespace vorotool::core::label_images {

// Writes 1 for the pixels with a 4-neighbor of larger label, else 0. Label 0 is no site: its pixels are
// never of the diagram, and as a neighbor it is never larger.
//
// `labels` and `diagram` are the row-major rows of a band, `width` wide. `above` and `below` are the rows
// next to the band, or empty at the border of the image, so that an image can be streamed in bands of any
// height. `labels` and `diagram` must not overlap.
template <class Label>
void mark_diagram(std::span<const Label> labels, std::size_t width, std::span<const Label> above,
                  std::span<const Label> below, std::span<std::uint8_t> diagram, unsigned threads,
                  const base::Monitor& monitor);

}  // namespace vorotool::core::label_images
