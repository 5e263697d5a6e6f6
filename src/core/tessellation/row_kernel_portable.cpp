// The kernels that run everywhere, and the choice between all of them.
#include "core/tessellation/lanes_scalar.hpp"
#include "core/tessellation/row_kernel_impl.hpp"

namespace vorotool::core::tessellation {

RowKernel<Narrow> kernels::portable() { return RowKernelOn<ScalarLanes<Narrow>>::table(); }

RowKernel<Filtered> kernels::filtered_portable() { return RowKernelOn<ScalarLanes<Filtered>>::table(); }

RowKernel<Wide> wide_kernel() { return RowKernelOn<ScalarLanes<Wide>>::table(); }

RowKernel<Narrow> narrow_kernel(Simd level) {
#if defined(__x86_64__)
  if (level == Simd::avx512) return kernels::avx512();
  if (level == Simd::avx2) return kernels::avx2();
#endif
  (void)level;
  return kernels::portable();
}

RowKernel<Filtered> filtered_kernel(Simd level) {
#if defined(__x86_64__)
  if (level != Simd::portable) return kernels::filtered_avx2();
#endif
  (void)level;
  return kernels::filtered_portable();
}

}  // namespace vorotool::core::tessellation
