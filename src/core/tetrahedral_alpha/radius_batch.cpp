#include "core/tetrahedral_alpha/radius_batch.hpp"

#include <cmath>

#include "core/tessellation/simd_level.hpp"
#include "core/tetrahedral_alpha/radius_batch_impl.hpp"

namespace vorotool::core::tetrahedral_alpha {

namespace {

struct Portable {
  static constexpr int bytes = 16;
  template <class Vector>
  static Vector root(const Vector& v) {
    return Vector{std::sqrt(v[0]), std::sqrt(v[1])};
  }
};

}  // namespace

RadiusBatch kernels::radii_portable() { return RadiusKernel<Portable>::batch; }

RadiusBatch radius_batch() {
#if defined(__x86_64__)
  static const bool is_wide = tessellation::supports(tessellation::Simd::avx2);
  if (is_wide) return kernels::radii_avx2();
#endif
  return kernels::radii_portable();
}

}  // namespace vorotool::core::tetrahedral_alpha
