// The paper's own algorithm (section 2.2): labels propagated by two passes over the image. Nearly exact.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/monitor.hpp"

namespace vorotool::core::tessellation {

// Seeds on pixels: seed i at column x[i], row y[i] of the image, with label[i]. The image is `width` x
// `height`. `out` receives labels row after row; 0 where nothing was propagated to (one pass only). The loops
// of the paper run over 2 ... m - 1: the image has an implicit frame of zero labels around it.
void propagate(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
               std::span<const std::uint32_t> label, std::int32_t width, std::int32_t height, int passes,
               std::uint32_t* out, const base::Monitor& monitor);

}  // namespace vorotool::core::tessellation
