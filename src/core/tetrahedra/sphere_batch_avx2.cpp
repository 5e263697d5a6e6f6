// Compiled with AVX2 enabled: only called after supports(Simd::avx2).
#if defined(__x86_64__)

#include <immintrin.h>

#include "core/tetrahedra/sphere_batch_impl.hpp"

namespace vorotool::core::tetrahedra {
namespace {

struct Avx2 {
  static constexpr int bytes = 32;
  template <class Chosen>
  static unsigned mask(const Chosen& chosen) {
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<const __m256d&>(chosen)));
  }
  template <class Vector>
  static Vector product_error(const Vector& a, const Vector& b, const Vector& product) {
    return _mm256_fmsub_pd(a, b, product);
  }
};

}  // namespace

SphereBatch kernels::spheres_avx2() { return SphereKernel<Avx2>::all; }

}  // namespace vorotool::core::tetrahedra

#endif
