// The kernels of any machine, and the choice among them.
#include "core/volumes/nearest_kernel_impl.hpp"

namespace vorotool::core::volumes {
namespace {

struct Portable {
  static constexpr int bytes = 16;
  static bool any(const void* vector) {
    const auto* const words = static_cast<const std::uint64_t*>(vector);
    return (words[0] | words[1]) != 0;
  }
};

}  // namespace

NearestKernels kernels::nearest_portable() { return nearest_kernels_of<Portable>(); }

NearestKernels nearest_kernels(tessellation::Simd level) {
#if defined(__x86_64__)
  if (level == tessellation::Simd::avx512) return kernels::nearest_avx512();
  if (level == tessellation::Simd::avx2) return kernels::nearest_avx2();
#endif
  return kernels::nearest_portable();
}

}  // namespace vorotool::core::volumes
