// The pixels of an image and the seeds of its tessellation on one lattice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace vorotool::core::tessellation {

// Coordinates of seeds and pixels on the lattice may have this magnitude.
constexpr std::int64_t lattice_limit = std::int64_t{1} << 40;

// Seeds on a lattice of `scale` steps a pixel; several may share a label. Labels are at least 1.
struct LatticeSeeds {
  std::span<const std::int64_t> x;
  std::span<const std::int64_t> y;
  std::span<const std::uint32_t> labels;
  std::int64_t scale;
};

// Pixel (c, r) of the image is at (scale * (x + c), scale * (y + r)) of the lattice.
struct PixelFrame {
  std::int64_t x;
  std::int64_t y;
  std::size_t width;
  std::size_t height;
};

}  // namespace vorotool::core::tessellation
