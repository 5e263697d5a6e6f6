// An exact check of a digital tessellation that shares nothing with the row sweep.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/monitor.hpp"
#include "core/site_tree.hpp"

namespace vorotool::core {

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

struct WrongPixels {
  std::uint64_t count = 0;
  std::size_t column = 0;  // of the first one in row-major order, when there is one
  std::size_t row = 0;
  std::uint32_t found = 0;
  std::uint32_t right = 0;
};

// Coordinates of seeds and pixels on the lattice may have this magnitude.
constexpr std::int64_t kLatticeLimit = std::int64_t{1} << 40;

// Compares every pixel with the label of the lexicographic minimum of (squared distance, label) over all
// seeds; with `limit`, a pixel whose squared lattice distance exceeds it must be 0. Exact: squared distances
// are at most 2^83, and are computed in 64 bits where coordinates differ by at most 2^31, else in 128.
// Throws std::out_of_range beyond kLatticeLimit.
template <class Label>
WrongPixels verify_labels(std::span<const Label> image, const PixelFrame& frame, const LatticeSeeds& seeds,
                          std::optional<uint128> limit, unsigned threads, const Monitor& monitor);

}  // namespace vorotool::core
