// Regions of a digital tessellation made 4-connected.
//
// The pixels of a Voronoi cell are those of a convex set, but a thin cell may hold pixels that no path of
// 4-neighbors inside the cell links to its site. The dual of a tessellation whose regions are connected is a
// planar triangulation (Cao, Edelsbrunner and Tan, "Proof of correctness of the digital Delaunay
// triangulation algorithm").
#pragma once

#include <cstdint>
#include <span>

#include "core/base/monitor.hpp"
#include "core/tessellation/pixel_frame.hpp"

namespace vorotool::core::digital {

struct Reconnection {
  std::uint64_t regions = 0;  // that were not connected
  std::uint64_t pixels = 0;   // that changed their label
};

// Site k has label k + 1; `image` is its exact tessellation, every pixel labelled. Of each region the part
// with the pixel nearest to its site stays. The others are flooded from their 4-neighbors: a pixel goes to
// the first label that reaches it if labels spread over the whole image at once, in order of (distance to the
// site, label).
Reconnection connect_regions(std::span<std::uint32_t> image, const tessellation::PixelFrame& frame,
                             std::span<const std::int64_t> x, std::span<const std::int64_t> y,
                             std::int64_t scale, unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::digital
