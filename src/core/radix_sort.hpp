// Stable least-significant-digit radix sort of keys with an index each.
#pragma once

#include <cstdint>
#include <vector>

namespace vorotool::core {

struct KeyedIndex {
  std::uint64_t key;
  std::uint32_t index;
};

// Sorts by the lowest `bits` bits of the key; equal keys keep their order. Time linear in the number of
// items.
void radix_sort(std::vector<KeyedIndex>& items, int bits);

}  // namespace vorotool::core
