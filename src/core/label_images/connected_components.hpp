// Connected components of a mask.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/monitor.hpp"

namespace vorotool::core::label_images {

enum class Connectivity { four, eight };  // pixels hang together by sides, or by corners, too

// Numbers the components of a row-major mask of zeros and ones from 1, in raster order of their first pixels;
// the other pixels get 0. Returns how many there are. Throws std::length_error beyond 2^32 - 2 provisional
// ones.
std::uint32_t label_components(std::span<const std::uint8_t> mask, std::size_t width,
                               Connectivity connectivity, std::span<std::uint32_t> numbers,
                               const base::Monitor& monitor);

}  // namespace vorotool::core::label_images
