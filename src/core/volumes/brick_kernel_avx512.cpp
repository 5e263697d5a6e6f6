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

#include "core/volumes/brick_kernel_impl.hpp"

namespace vorotool::core::volumes {
namespace {

struct Avx512 {
  static constexpr int bytes = 32;  // of a row of a brick
  template <class Vector>
  static std::uint32_t mask(const Vector& chosen) {
    return _mm256_movepi32_mask(reinterpret_cast<const __m256i&>(chosen));
  }
  template <class Element>
  static void compress(Element* out, std::uint32_t stays, const Element* from) {
    const __m256i values = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out),
                        _mm256_maskz_compress_epi32(static_cast<__mmask8>(stays), values));
  }
};

}  // namespace

BrickKernels kernels::bricks_avx512() { return brick_kernels_of<Avx512>(); }

}  // namespace vorotool::core::volumes

#endif
