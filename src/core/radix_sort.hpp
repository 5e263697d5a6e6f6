// Stable least-significant-digit radix sort of keys with a number each.
#pragma once

#include <cstdint>
#include <vector>

namespace vorotool::core {

struct Keyed {
  std::uint64_t key;
  std::uint32_t value;  // goes with the key: an index, a label
};

// Sorts by the lowest `bits` bits of the key; equal keys keep their order. Time linear in the number of
// items.
void radix_sort(std::vector<Keyed>& items, int bits);

}  // namespace vorotool::core
