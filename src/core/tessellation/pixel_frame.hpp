// The pixels of an image and the seeds of its tessellation on one lattice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace vorotool::core::tessellation {

// Coordinates of seeds and pixels on the lattice may have this magnitude.
constexpr std::int64_t lattice_limit = std::int64_t{1} << 40;

// Sides of a pixel, in steps of the lattice.
struct PixelSides {
  std::int64_t x;
  std::int64_t y;
};

// Seeds on a lattice; several may share a label. Labels are at least 1.
struct LatticeSeeds {
  std::span<const std::int64_t> x;
  std::span<const std::int64_t> y;
  std::span<const std::uint32_t> labels;
  PixelSides pixel;
};

// Pixel (c, r) of the image is at (sides.x * (x + c), sides.y * (y + r)) of the lattice.
struct PixelFrame {
  std::int64_t x;
  std::int64_t y;
  std::size_t width;
  std::size_t height;
};

}  // namespace vorotool::core::tessellation
