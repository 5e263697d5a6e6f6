// Compressed bytes of TIFF files.
#include <nanobind/nanobind.h>

#include <cstdint>
#include <span>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/compression/packed_bytes.hpp"

namespace vorotool::bindings {
namespace {

std::span<const std::uint8_t> bytes_of(const nb::bytes& data) {
  return {reinterpret_cast<const std::uint8_t*>(data.c_str()), data.size()};
}

auto unpack_lzw(const nb::bytes& data, std::size_t limit) {
  const std::span<const std::uint8_t> packed = bytes_of(data);
  try {
    return to_numpy(run_interruptible({}, core::compression::unpack_lzw, packed, limit));
  } catch (const core::compression::DamagedCode& error) {
    throw nb::value_error(error.what());
  }
}

auto unpack_packbits(const nb::bytes& data, std::size_t limit) {
  const std::span<const std::uint8_t> packed = bytes_of(data);
  return to_numpy(run_interruptible({}, core::compression::unpack_packbits, packed, limit));
}

}  // namespace

void bind_compression(nb::module_& room) {
  room.def("unpack_lzw", &unpack_lzw, "data"_a, "limit"_a);
  room.def("unpack_packbits", &unpack_packbits, "data"_a, "limit"_a);
}

}  // namespace vorotool::bindings
