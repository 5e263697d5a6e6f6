// Which vector instructions a kernel uses; chosen at run time, so that one build runs everywhere.
#pragma once

#include <string_view>

namespace vorotool::core::tessellation {

enum class Simd { portable, avx2, avx512 };

// Whether this machine (and this build) can run the kernels of a level.
bool supports(Simd level);

// The widest level that this machine can run.
Simd widest_simd();

std::string_view name_of(Simd level);

}  // namespace vorotool::core::tessellation
