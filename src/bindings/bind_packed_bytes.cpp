// Compressed bytes of TIFF files.
#include <nanobind/nanobind.h>

#include <cstdint>
#include <span>

#include "arrays.hpp"
#include "bindings.hpp"
#include "core/compression/packed_bytes.hpp"
#include "interrupts.hpp"

namespace vorotool::bindings {
namespace {

namespace nb = nanobind;

std::span<const std::uint8_t> bytes_of(const nb::bytes& data) {
  return {reinterpret_cast<const std::uint8_t*>(data.c_str()), data.size()};
}

nb::object unpack_lzw(const nb::bytes& data, std::size_t limit) {
  const std::span<const std::uint8_t> packed = bytes_of(data);
  try {
    return to_numpy(run_interruptible(nb::none(), [&](const core::base::Monitor& monitor) {
      return core::compression::unpack_lzw(packed, limit, monitor);
    }));
  } catch (const core::compression::DamagedCode& error) {
    throw nb::value_error(error.what());
  }
}

nb::object unpack_packbits(const nb::bytes& data, std::size_t limit) {
  const std::span<const std::uint8_t> packed = bytes_of(data);
  return to_numpy(run_interruptible(nb::none(), [&](const core::base::Monitor& monitor) {
    return core::compression::unpack_packbits(packed, limit, monitor);
  }));
}

}  // namespace

void bind_packed_bytes(nb::module_& module) {
  using nb::literals::operator""_a;
  module.def("unpack_lzw", &unpack_lzw, "data"_a, "limit"_a);
  module.def("unpack_packbits", &unpack_packbits, "data"_a, "limit"_a);
}

}  // namespace vorotool::bindings
