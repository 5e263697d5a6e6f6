// The kernels of any machine, and the choice among them.
#include "core/volumes/brick_kernel_impl.hpp"

namespace vorotool::core::volumes {
namespace {

struct Portable {
  static constexpr int bytes = 16;
  template <class Vector>
  static std::uint32_t mask(const Vector& chosen) {
    std::uint32_t bits = 0;
    for (std::uint32_t lane = 0; lane < 4; ++lane) bits |= (chosen[lane] != 0 ? 1U : 0U) << lane;
    return bits;
  }
  template <class Element>
  static void compress(Element* out, std::uint32_t stays, const Element* from) {
    for (; stays != 0; stays &= stays - 1) *out++ = from[__builtin_ctz(stays)];
  }
};

}  // namespace

BrickKernels kernels::bricks_portable() { return brick_kernels_of<Portable>(); }

BrickKernels brick_kernels(tessellation::Simd level) {
#if defined(__x86_64__)
  if (level == tessellation::Simd::avx512) return kernels::bricks_avx512();
  if (level == tessellation::Simd::avx2) return kernels::bricks_avx2();
#endif
  return kernels::bricks_portable();
}

}  // namespace vorotool::core::volumes
