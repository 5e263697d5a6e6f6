// The two compressions of TIFF that no library at hand undoes up to a limit: LZW and PackBits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "core/base/monitor.hpp"

namespace vorotool::core::compression {

// A code that stands for nothing.
struct DamagedCode : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The bytes that codes stand for, in the order of bits and with the early change of width of TIFF 6.0
// (section 13). It ends at the code that ends them, with the data, or after `limit` bytes, whichever is
// first.
std::vector<std::uint8_t> unpack_lzw(std::span<const std::uint8_t> data, std::size_t limit,
                                     const base::Monitor& monitor);

// The bytes of runs and literals (TIFF 6.0, section 9); ends with the data, or after `limit` bytes.
std::vector<std::uint8_t> unpack_packbits(std::span<const std::uint8_t> data, std::size_t limit,
                                          const base::Monitor& monitor);

}  // namespace vorotool::core::compression
