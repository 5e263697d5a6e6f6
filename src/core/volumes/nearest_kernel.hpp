// The inner loops of the tiles of dense seeds: one table of functions for each instruction set.
//
// What a voxel knows of its nearest seed is one word, the key: its squared distance, and in the lowest bits its label.
// Less is nearer, or as near with a smaller label; and a square that is added to the distance keeps the order.
//
// The kernel files are compiled for wider instruction sets than the rest. They take raw pointers and call nothing from
// the standard library, so that no inline function compiled for a wide machine is linked elsewhere.
#pragma once

#include <cstdint>

#include "core/tessellation/simd_level.hpp"

namespace vorotool::core::volumes {

// Voxels of a plane of a tile, along x and y, and those that are computed at a time: most around a disc, and of a slice.
inline constexpr std::int32_t tile_width = 256;
inline constexpr std::int32_t tile_height = 8;
inline constexpr std::int32_t tile_voxels = tile_width * tile_height;
inline constexpr std::int32_t group = 16;
inline constexpr std::int32_t chunk = 32;

// A key that no seed has; another square may still be added.
template <class Key>
inline constexpr Key no_seed = Key{1} << (8 * sizeof(Key) - 1);

// A seed and the voxels of a plane that may be nearest to it.
struct Disc {
  std::int32_t column, columns;
  std::int32_t row, rows;
  std::int32_t x, step_x;  // from the seed to the first column; to the next column
  std::int32_t y, step_y;
  std::uint32_t label;
  int label_bits;
};

// The planes below and above a slice: each adds the square of its distance.
template <class Key>
struct Stack {
  const Key* const* planes;  // [2 reach + 1] from the lowest; the slice's own is in the middle
  std::int32_t reach;
  const Key* square;  // [reach + 1] added at each distance
};

template <class Key>
struct NearestKernel {
  // Lets the voxels of a plane know a seed of its slice.
  void (*add_disc)(const Disc&, Key* plane);
  // Keys of `chunk` voxels from the stack; gives the largest.
  Key (*merge)(const Stack<Key>&, std::int32_t offset, Key* keys);
  // Labels of keys less than `limit`, else 0.
  void (*labels8)(const Key* keys, Key limit, Key label_mask, std::uint8_t* out);
  void (*labels16)(const Key* keys, Key limit, Key label_mask, std::uint16_t* out);
  void (*labels32)(const Key* keys, Key limit, Key label_mask, std::uint32_t* out);
  void (*squares32)(const Key* keys, int label_bits, std::uint32_t* out);
  void (*squares64)(const Key* keys, int label_bits, std::uint64_t* out);
};

// Keys of 32 bits, and of 64.
struct NearestKernels {
  NearestKernel<std::uint32_t> narrow;
  NearestKernel<std::uint64_t> wide;
};

NearestKernels nearest_kernels(tessellation::Simd level);

namespace kernels {  // one definition a file: nearest_kernel_<level>.cpp
NearestKernels nearest_portable();
NearestKernels nearest_avx2();
NearestKernels nearest_avx512();
}  // namespace kernels

}  // namespace vorotool::core::volumes
