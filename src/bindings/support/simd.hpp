// Instruction sets by their names.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "core/tessellation/simd_level.hpp"

namespace vorotool::bindings {

inline core::tessellation::Simd simd_level(std::string_view name) {
  using core::tessellation::Simd;
  for (const Simd level : {Simd::portable, Simd::avx2, Simd::avx512}) {
    if (name == core::tessellation::name_of(level)) {
      if (core::tessellation::supports(level)) return level;
      throw std::invalid_argument(std::string(name) + " is not supported by this machine");
    }
  }
  throw std::invalid_argument("unknown instruction set " + std::string(name));
}

}  // namespace vorotool::bindings
