#include "core/tessellation/simd_level.hpp"

namespace vorotool::core::tessellation {

bool supports(Simd level) {
  if (level == Simd::portable) return true;
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (level == Simd::avx2) {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  }
  return supports(Simd::avx2) && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
#else
  return false;
#endif
}

Simd widest_simd() {
  if (supports(Simd::avx512)) return Simd::avx512;
  return supports(Simd::avx2) ? Simd::avx2 : Simd::portable;
}

std::string_view name_of(Simd level) {
  switch (level) {
    case Simd::avx512:
      return "avx512";
    case Simd::avx2:
      return "avx2";
    default:
      return "portable";
  }
}

}  // namespace vorotool::core::tessellation
