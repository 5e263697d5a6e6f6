// Compiled with AVX2 enabled: only called after supports(Simd::avx2).
#if defined(__x86_64__)

#include <immintrin.h>

#include "core/tetrahedral_alpha/radius_batch_impl.hpp"

namespace vorotool::core::tetrahedral_alpha {
namespace {

struct Avx2 {
  static constexpr int bytes = 32;
  template <class Vector>
  static Vector root(const Vector& v) {
    return reinterpret_cast<Vector>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(v)));
  }
};

}  // namespace

RadiusBatch kernels::radii_avx2() { return RadiusKernel<Avx2>::batch; }

}  // namespace vorotool::core::tetrahedral_alpha

#endif
