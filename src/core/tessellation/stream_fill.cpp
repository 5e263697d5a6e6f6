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
  base::parallel_for(base::piece_count(bytes, piece), threads, [&](std::size_t index) {
    const std::size_t end = std::min(bytes, (index + 1) * piece);
    for (std::size_t i = index * piece; i < end; i += block)
      kernel.stream(out + i, ones.data(), std::min(block, end - i));
    kernel.fence();
  });
}

}  // namespace vorotool::core::tessellation
