#include "core/tessellation/stream_fill.hpp"

#include <algorithm>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/tessellation/row_kernel.hpp"

namespace vorotool::core::tessellation {

void stream_fill(char* out, std::size_t bytes, unsigned threads) {
  constexpr std::size_t block = std::size_t{1} << 14;  // stays in the first-level cache
  constexpr std::size_t piece = std::size_t{1} << 24;
  const RowKernel<Narrow> kernel = narrow_kernel(widest_simd());
  const std::vector<char> ones(block, 1);
  const auto fill = [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; i += block)
      kernel.stream(out + i, ones.data(), std::min(block, end - i));
    kernel.fence();
  };
  base::for_pieces(bytes, piece, threads, {}, fill);
}

}  // namespace vorotool::core::tessellation
