// Eight lanes of AVX-512. Compiled with AVX-512 enabled: only called after supports(Simd::avx512).
#if defined(__x86_64__)

// Registers that these functions leave undefined on purpose are initialized with themselves in the header of GCC 12,
// which warns of it.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
#include <immintrin.h>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#include "core/tessellation/row_kernel_impl.hpp"

namespace vorotool::core::tessellation {
namespace {

struct Avx512Lanes {
  using Arithmetic = Narrow;
  using Mask = std::uint32_t;
  static constexpr std::int32_t width = 8;
  static constexpr int bytes = 64;

  static __m512d load(const double* p) { return _mm512_loadu_pd(p); }
  static __m256i coordinates(const std::int32_t* y) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(y));
  }
  static __m512d above(std::int32_t row, const std::int32_t* y) {
    return _mm512_cvtepi32_pd(_mm256_sub_epi32(_mm256_set1_epi32(row), coordinates(y)));
  }
  static __m512d below(std::int32_t row, const std::int32_t* y) {
    return _mm512_cvtepi32_pd(_mm256_sub_epi32(coordinates(y), _mm256_set1_epi32(row)));
  }
  static void set_coordinates(std::int32_t* y, Mask which, std::int32_t v) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(y),
                        choose_index(which, coordinates(y), _mm256_set1_epi32(v)));
  }
  static __m512d broadcast(std::int32_t v) { return _mm512_set1_pd(v); }
  static __m512d add(__m512d a, __m512d b) { return _mm512_add_pd(a, b); }
  static __m512d sub(__m512d a, __m512d b) { return _mm512_sub_pd(a, b); }
  static __m512d mul(__m512d a, __m512d b) { return _mm512_mul_pd(a, b); }
  static __m512d scale(__m512d a, std::int64_t factor) {
    return _mm512_mul_pd(a, _mm512_set1_pd(static_cast<double>(factor)));
  }
  static Mask less(__m512d a, __m512d b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
  static Mask equal(__m512d a, __m512d b) { return _mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ); }
  static __m512d choose(Mask second, __m512d a, __m512d b) {
    return _mm512_mask_blend_pd(static_cast<__mmask8>(second), a, b);
  }
  // Compressed in a register, then stored whole: a compressing store is microcoded on some processors.
  static void compress(double* out, Mask keep, __m512d v) {
    _mm512_storeu_pd(out, _mm512_maskz_compress_pd(static_cast<__mmask8>(keep), v));
  }

  static void store_index(std::uint32_t* out, __m256i v) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), v);
  }
  static __m256i load_index(const std::uint32_t* p) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
  }
  static __m256i choose_index(Mask second, __m256i a, __m256i b) {
    return _mm256_mask_blend_epi32(static_cast<__mmask8>(second), a, b);
  }
  static __m256i min_index(__m256i a, __m256i b) { return _mm256_min_epu32(a, b); }
  static __m256i count_from(std::int32_t first) {
    return _mm256_add_epi32(_mm256_set1_epi32(first), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
  }
  static void compress_index(std::uint32_t* out, Mask keep, __m256i v) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out),
                        _mm256_maskz_compress_epi32(static_cast<__mmask8>(keep), v));
  }

  // floor(rise / run): the rounded quotient is off by less than one, the fused remainder is exact and tells.
  static Mask divide(__m512d rise, __m512d run, Mask, const PixelRow& pixels, std::int32_t* end) {
    const __m512d one = _mm512_set1_pd(1.0);
    const __m512d zero = _mm512_setzero_pd();
    __m512d quotient =
        _mm512_roundscale_pd(_mm512_div_pd(rise, run), _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
    const __m512d remainder = _mm512_fnmadd_pd(quotient, run, rise);
    const __mmask8 too_large = _mm512_cmp_pd_mask(remainder, zero, _CMP_LT_OQ);
    const __mmask8 too_small = _mm512_cmp_pd_mask(remainder, run, _CMP_GE_OQ);
    quotient = _mm512_mask_sub_pd(quotient, too_large, quotient, one);
    quotient = _mm512_mask_add_pd(quotient, too_small, quotient, one);
    const __mmask8 exact =
        _mm512_cmp_pd_mask(remainder, zero, _CMP_EQ_OQ) | _mm512_cmp_pd_mask(remainder, run, _CMP_EQ_OQ);
    const __m512d pixel = _mm512_add_pd(quotient, _mm512_set1_pd(pixels.middle));
    const __m512d last = _mm512_set1_pd(pixels.width - 1);
    const __mmask8 inside =
        _mm512_cmp_pd_mask(pixel, zero, _CMP_GE_OQ) & _mm512_cmp_pd_mask(pixel, last, _CMP_LE_OQ);
    const __m512d clamped = _mm512_min_pd(_mm512_max_pd(pixel, _mm512_set1_pd(-1.0)), last);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(end), _mm512_cvttpd_epi32(clamped));
    return exact & inside;
  }

  static void stream(void* target, const void* source, std::size_t count) {
    auto* to = static_cast<char*>(target);
    const auto* from = static_cast<const char*>(source);
    const std::size_t head = -reinterpret_cast<std::uintptr_t>(to) % 64;
    std::size_t i = head < count ? head : count;
    __builtin_memcpy(to, from, i);
    for (; i + 64 <= count; i += 64) {
      _mm512_stream_si512(reinterpret_cast<__m512i*>(to + i), _mm512_loadu_si512(from + i));
    }
    __builtin_memcpy(to + i, from + i, count - i);
  }
  static void fence() { _mm_sfence(); }
};

}  // namespace

RowKernel<Narrow> kernels::avx512() { return RowKernelOn<Avx512Lanes>::table(); }

}  // namespace vorotool::core::tessellation

#endif
