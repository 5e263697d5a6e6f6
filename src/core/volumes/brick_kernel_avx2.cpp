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
};

}  // namespace

BrickKernels kernels::bricks_avx2() { return brick_kernels_of<Avx2>(); }

}  // namespace vorotool::core::volumes

#endif
