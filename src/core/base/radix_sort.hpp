// Stable least-significant-digit radix sort. By 33 bits it takes 43 ns an item, boost::sort::spreadsort,
// which is not stable, 111 and std::stable_sort 111 (tests/benchmarks/core_parts.cpp).
#pragma once

#include <cstdint>
#include <span>

namespace vorotool::core::base {

// A key and a number that goes with it: an index, a label.
struct Keyed {
  std::uint64_t key;
  std::uint32_t value;
};

// Sorts by the lowest `bits` bits of the key; equal keys keep their order, on any number of threads. Time linear in the
// number of items.
void radix_sort(std::span<Keyed> items, int bits, unsigned threads = 1);

// Sorts words by their bits low ... high - 1 alone; the others go along. Half the memory of Keyed, where all
// fits.
void radix_sort(std::span<std::uint64_t> words, int low, int high, unsigned threads = 1);

}  // namespace vorotool::core::base
