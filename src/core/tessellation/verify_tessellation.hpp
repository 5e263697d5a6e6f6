// An exact check of a digital tessellation that shares nothing with the row sweep.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/base/monitor.hpp"
#include "core/spatial/kd_tree.hpp"
#include "core/tessellation/pixel_frame.hpp"

namespace vorotool::core::tessellation {

struct WrongPixels {
  std::uint64_t count = 0;
  std::size_t column = 0;  // of the first one in row-major order, when there is one
  std::size_t row = 0;
  std::uint32_t found = 0;
  std::uint32_t right = 0;
};

// Compares every pixel with the label of the lexicographic minimum of (squared distance, label) over all
// seeds; with `limit`, a pixel whose squared lattice distance exceeds it must be 0. Exact: squared distances
// are at most 2^83, and are computed in 64 bits where coordinates differ by at most 2^31, else in 128.
// Throws std::out_of_range beyond lattice_limit.
template <class Label>
WrongPixels verify_tessellation(std::span<const Label> image, const PixelFrame& frame,
                                const LatticeSeeds& seeds, std::optional<numbers::uint128> limit,
                                unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::tessellation
