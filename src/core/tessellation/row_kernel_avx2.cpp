// Four lanes of AVX2. Compiled with AVX2 enabled: only called after supports(Simd::avx2).
#if defined(__x86_64__)

#include <immintrin.h>

#include "core/tessellation/row_kernel_impl.hpp"

namespace vorotool::core::tessellation {
namespace {

// Byte shuffles that move the chosen 32-bit elements of 128 bits to the front; for doubles, the same on
// pairs.
struct CompressTables {
  alignas(16) std::uint8_t index[16][16];
  alignas(32) std::uint32_t pair[16][8];
};

constexpr CompressTables make_tables() {
  CompressTables t{};
  for (unsigned mask = 0; mask < 16; ++mask) {
    unsigned n = 0;
    for (unsigned lane = 0; lane < 4; ++lane) {
      if ((mask >> lane & 1) == 0) continue;
      for (unsigned byte = 0; byte < 4; ++byte) {
        t.index[mask][4 * n + byte] = static_cast<std::uint8_t>(4 * lane + byte);
      }
      t.pair[mask][2 * n] = 2 * lane;
      t.pair[mask][2 * n + 1] = 2 * lane + 1;
      ++n;
    }
  }
  return t;
}

constexpr CompressTables tables = make_tables();

struct Avx2Lanes {
  using Arithmetic = Narrow;
  using Mask = std::uint32_t;
  static constexpr std::int32_t width = 4;
  static constexpr int bytes = 32;

  static __m256d load(const double* p) { return _mm256_loadu_pd(p); }
  static __m128i coordinates(const std::int32_t* y) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(y));
  }
  static __m256d above(std::int32_t row, const std::int32_t* y) {
    return _mm256_cvtepi32_pd(_mm_sub_epi32(_mm_set1_epi32(row), coordinates(y)));
  }
  static __m256d below(std::int32_t row, const std::int32_t* y) {
    return _mm256_cvtepi32_pd(_mm_sub_epi32(coordinates(y), _mm_set1_epi32(row)));
  }
  static void set_coordinates(std::int32_t* y, Mask which, std::int32_t v) {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(y), choose_index(which, coordinates(y), _mm_set1_epi32(v)));
  }
  static __m256d broadcast(std::int32_t v) { return _mm256_set1_pd(v); }
  static __m256d times(__m256d a, double factor) { return _mm256_mul_pd(a, _mm256_set1_pd(factor)); }
  static __m256d add(__m256d a, __m256d b) { return _mm256_add_pd(a, b); }
  static __m256d sub(__m256d a, __m256d b) { return _mm256_sub_pd(a, b); }
  static __m256d mul(__m256d a, __m256d b) { return _mm256_mul_pd(a, b); }
  static __m256d scale(__m256d a, std::int64_t factor) {
    return _mm256_mul_pd(a, _mm256_set1_pd(static_cast<double>(factor)));
  }
  static Mask less(__m256d a, __m256d b) { return bits(_mm256_cmp_pd(a, b, _CMP_LT_OQ)); }
  static Mask equal(__m256d a, __m256d b) { return bits(_mm256_cmp_pd(a, b, _CMP_EQ_OQ)); }
  static Mask bits(__m256d m) { return static_cast<Mask>(_mm256_movemask_pd(m)); }
  static __m256d choose(Mask second, __m256d a, __m256d b) {
    return _mm256_blendv_pd(a, b, _mm256_castsi256_pd(spread(second)));
  }
  // All bits of the lanes of a mask.
  static __m256i spread(Mask mask) {
    const __m256i lane = _mm256_setr_epi64x(1, 2, 4, 8);
    return _mm256_cmpeq_epi64(_mm256_and_si256(_mm256_set1_epi64x(mask), lane), lane);
  }
  static void compress(double* out, Mask keep, __m256d v) {
    const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(tables.pair[keep]));
    _mm256_storeu_ps(reinterpret_cast<float*>(out), _mm256_permutevar8x32_ps(_mm256_castpd_ps(v), order));
  }

  static void store_index(std::uint32_t* out, __m128i v) {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out), v);
  }
  static __m128i load_index(const std::uint32_t* p) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p));
  }
  static __m128i choose_index(Mask second, __m128i a, __m128i b) {
    const __m128i lane = _mm_setr_epi32(1, 2, 4, 8);
    const __m128i chosen =
        _mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(static_cast<int>(second)), lane), lane);
    return _mm_blendv_epi8(a, b, chosen);
  }
  static __m128i min_index(__m128i a, __m128i b) { return _mm_min_epu32(a, b); }
  static __m128i count_from(std::int32_t first) {
    return _mm_add_epi32(_mm_set1_epi32(first), _mm_setr_epi32(0, 1, 2, 3));
  }
  static void compress_index(std::uint32_t* out, Mask keep, __m128i v) {
    const __m128i order = _mm_load_si128(reinterpret_cast<const __m128i*>(tables.index[keep]));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out), _mm_shuffle_epi8(v, order));
  }

  // floor(rise / run): the rounded quotient is off by less than one, the fused remainder is exact and tells.
  static Mask divide(__m256d rise, __m256d run, Mask, const PixelRow& pixels, std::int32_t* end) {
    const __m256d one = _mm256_set1_pd(1.0);
    const __m256d zero = _mm256_setzero_pd();
    __m256d quotient = _mm256_floor_pd(_mm256_div_pd(rise, run));
    const __m256d remainder = _mm256_fnmadd_pd(quotient, run, rise);
    const __m256d too_large = _mm256_cmp_pd(remainder, zero, _CMP_LT_OQ);
    const __m256d too_small = _mm256_cmp_pd(remainder, run, _CMP_GE_OQ);
    quotient = _mm256_sub_pd(quotient, _mm256_and_pd(too_large, one));
    quotient = _mm256_add_pd(quotient, _mm256_and_pd(too_small, one));
    const Mask exact = equal(remainder, zero) | equal(remainder, run);
    const __m256d pixel = _mm256_add_pd(quotient, _mm256_set1_pd(pixels.middle));
    const __m256d last = _mm256_set1_pd(pixels.width - 1);
    const Mask inside =
        bits(_mm256_cmp_pd(pixel, zero, _CMP_GE_OQ)) & bits(_mm256_cmp_pd(pixel, last, _CMP_LE_OQ));
    const __m256d clamped = _mm256_min_pd(_mm256_max_pd(pixel, _mm256_set1_pd(-1.0)), last);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(end), _mm256_cvttpd_epi32(clamped));
    return exact & inside;
  }

  static void stream(void* target, const void* source, std::size_t count) {
    auto* to = static_cast<char*>(target);
    const auto* from = static_cast<const char*>(source);
    const std::size_t head = -reinterpret_cast<std::uintptr_t>(to) % 32;
    std::size_t i = head < count ? head : count;
    __builtin_memcpy(to, from, i);
    for (; i + 32 <= count; i += 32) {
      _mm256_stream_si256(reinterpret_cast<__m256i*>(to + i),
                          _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from + i)));
    }
    __builtin_memcpy(to + i, from + i, count - i);
  }
  static void fence() { _mm_sfence(); }
};

// The same lanes with coordinates of 64 bits.
struct Avx2FilteredLanes : Avx2Lanes {
  using Arithmetic = Filtered;

  static __m256i coordinates(const std::int64_t* y) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(y));
  }
  // Integers below 2^51 as doubles: added to the bits of 1.5 * 2^52 they are its last bits.
  static __m256d doubles(__m256i v) {
    const __m256d magic = _mm256_set1_pd(0x1.8p52);
    return _mm256_sub_pd(_mm256_castsi256_pd(_mm256_add_epi64(v, _mm256_castpd_si256(magic))), magic);
  }
  static __m256d above(std::int64_t row, const std::int64_t* y) {
    return doubles(_mm256_sub_epi64(_mm256_set1_epi64x(row), coordinates(y)));
  }
  static __m256d below(std::int64_t row, const std::int64_t* y) {
    return doubles(_mm256_sub_epi64(coordinates(y), _mm256_set1_epi64x(row)));
  }
  static void set_coordinates(std::int64_t* y, Mask which, std::int64_t v) {
    _mm256_maskstore_epi64(reinterpret_cast<long long*>(y), spread(which), _mm256_set1_epi64x(v));
  }
  static __m256d broadcast(std::int64_t v) { return _mm256_set1_pd(static_cast<double>(v)); }

  // The boundary where the error of the quotient cannot change it, else doubt.
  static Mask bracket(__m256d rise, __m256d run, __m256d error, const PixelRow& pixels, std::int32_t* end) {
    const __m256d quotient = _mm256_div_pd(rise, run);
    const __m256d margin = _mm256_div_pd(error, run);
    const __m256d low = pixel(_mm256_sub_pd(quotient, margin), pixels);
    const __m256d high = pixel(_mm256_add_pd(quotient, margin), pixels);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(end), _mm256_cvttpd_epi32(low));
    return bits(_mm256_cmp_pd(low, high, _CMP_NEQ_UQ));
  }
  static __m256d pixel(__m256d at, const PixelRow& pixels) {
    const __m256d p = _mm256_add_pd(_mm256_floor_pd(at), _mm256_set1_pd(pixels.middle));
    return _mm256_min_pd(_mm256_max_pd(p, _mm256_set1_pd(-1.0)), _mm256_set1_pd(pixels.width - 1));
  }
};

}  // namespace

RowKernel<Filtered> kernels::filtered_avx2() { return RowKernelOn<Avx2FilteredLanes>::table(); }

RowKernel<Narrow> kernels::avx2() { return RowKernelOn<Avx2Lanes>::table(); }

}  // namespace vorotool::core::tessellation

#endif
