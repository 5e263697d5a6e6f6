// The digital Voronoi diagram of section 2.1, with one more axis.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/monitor.hpp"

namespace vorotool::core::volumes {

// Writes 1 for the voxels with a neighbor across a face of larger label, else 0. Label 0 is no site: its voxels
// are never of the diagram, and as a neighbor it is never larger.
//
// `labels` and `diagram` are slices of width * height voxels. `before` and `after` are the slices next to them, or
// empty at the border of the volume, so that a volume can be streamed in slabs of any depth. `labels` and `diagram`
// must not overlap.
template <class Label>
void mark_diagram(std::span<const Label> labels, std::size_t width, std::size_t height,
                  std::span<const Label> before, std::span<const Label> after,
                  std::span<std::uint8_t> diagram, unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::volumes
