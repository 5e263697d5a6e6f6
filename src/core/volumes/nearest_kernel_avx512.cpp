// Compiled with AVX-512 enabled: only called after supports(Simd::avx512).
#if defined(__x86_64__)

// Registers that these functions leave undefined on purpose are initialized with themselves in the header of GCC 12,
// which warns of it.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
#include <immintrin.h>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#include "core/volumes/nearest_kernel_impl.hpp"

namespace vorotool::core::volumes {
namespace {

struct Avx512 {
  static constexpr int bytes = 64;
  static bool any(const void* vector) {
    const auto* const words = static_cast<const __m512i*>(vector);
    return _mm512_test_epi64_mask(*words, *words) != 0;
  }
};

}  // namespace

NearestKernels kernels::nearest_avx512() { return nearest_kernels_of<Avx512>(); }

}  // namespace vorotool::core::volumes

#endif
