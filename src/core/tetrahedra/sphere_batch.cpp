#include "core/tetrahedra/sphere_batch.hpp"

#include "core/tessellation/simd_level.hpp"
#include "core/tetrahedra/sphere_batch_impl.hpp"

namespace vorotool::core::tetrahedra {

namespace {

struct Portable {
  static constexpr int bytes = 16;
  template <class Chosen>
  static unsigned mask(const Chosen& chosen) {
    return static_cast<unsigned>((chosen[0] & 1) | (chosen[1] & 2));
  }
};

}  // namespace

SphereBatch kernels::spheres_portable() { return SphereKernel<Portable>::all; }

SphereBatch sphere_batch() {
#if defined(__x86_64__)
  static const bool is_wide = tessellation::supports(tessellation::Simd::avx2);
  if (is_wide) return kernels::spheres_avx2();
#endif
  return kernels::spheres_portable();
}

}  // namespace vorotool::core::tetrahedra
