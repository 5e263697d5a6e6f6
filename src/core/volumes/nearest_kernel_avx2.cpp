// Compiled with AVX2 enabled: only called after supports(Simd::avx2).
#if defined(__x86_64__)

#include <immintrin.h>

#include "core/volumes/nearest_kernel_impl.hpp"

namespace vorotool::core::volumes {
namespace {

struct Avx2 {
  static constexpr int bytes = 32;
  static bool any(const void* vector) {
    const auto* const words = static_cast<const __m256i*>(vector);
    return !_mm256_testz_si256(*words, *words);
  }
};

}  // namespace

NearestKernels kernels::nearest_avx2() { return nearest_kernels_of<Avx2>(); }

}  // namespace vorotool::core::volumes

#endif
