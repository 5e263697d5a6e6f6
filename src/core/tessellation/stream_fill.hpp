// The physical limit that the tessellation is measured against: filling memory past the caches.
#pragma once

#include <cstddef>

namespace vorotool::core::tessellation {

// Writes ones over `bytes` bytes with non-temporal stores (plain ones where a machine has none).
void stream_fill(char* out, std::size_t bytes, unsigned threads);

}  // namespace vorotool::core::tessellation
