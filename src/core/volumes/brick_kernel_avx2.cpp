// Compiled with AVX2 enabled: only called after supports(Simd::avx2).
#if defined(__x86_64__)

#include <immintrin.h>

#include "core/volumes/brick_kernel_impl.hpp"

namespace vorotool::core::volumes {
namespace {

struct Avx2 {
  static constexpr int bytes = 32;
  template <class Vector>
  static std::uint32_t mask(const Vector& chosen) {
    return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<const __m256&>(chosen)));
  }
  template <class Element>
  static void compress(Element* out, std::uint32_t stays, const Element* from) {
    // a byte for each lane: those that stay, moved together
    const std::uint64_t lanes = _pdep_u64(stays, 0x0101010101010101U) * 0xff;
    const auto order = static_cast<long long>(_pext_u64(0x0706050403020100U, lanes));
    const __m256i places = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(order));
    const __m256i values = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm256_permutevar8x32_epi32(values, places));
  }
};

}  // namespace

BrickKernels kernels::bricks_avx2() { return brick_kernels_of<Avx2>(); }

}  // namespace vorotool::core::volumes

#endif
