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
  // As T. J. Dekker (1971), of factors below 2^996.
  template <class Vector>
  static Vector product_error(const Vector& a, const Vector& b, const Vector& product) {
    const auto head_of = [](const Vector& v) {
      const Vector large = v * (0x1p27 + 1);
      return large - (large - v);
    };
    const Vector a_head = head_of(a), b_head = head_of(b), a_tail = a - a_head, b_tail = b - b_head;
    return a_tail * b_tail - (((product - a_head * b_head) - a_tail * b_head) - a_head * b_tail);
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
