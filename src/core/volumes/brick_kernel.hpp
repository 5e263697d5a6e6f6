// The inner loops of the bricks of a volume: one table of functions for each instruction set.
//
// What a voxel knows of its nearest seed is one word, the key: its squared distance, and in the lowest bits its label.
// Less is nearer, or as near with a smaller label.
//
// The kernel files are compiled for wider instruction sets than the rest. They take raw pointers and call nothing from
// the standard library, so that no inline function compiled for a wide machine is linked elsewhere.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/tessellation/simd_level.hpp"

namespace vorotool::core::volumes {

// Voxels along each side of a brick.
inline constexpr std::int32_t brick_side = 8;
inline constexpr std::int32_t brick_voxels = brick_side * brick_side * brick_side;

// Arrays that are read and written in whole vectors have this many spare elements behind their end.
inline constexpr std::int32_t seed_padding = 16;

// Seeds on the lattice, in floats, which hold each coordinate of at most 2^24.
struct SeedArrays {
  float* x;
  float* y;
  float* z;
  std::uint32_t* label;
};

// Places low ... high of the lattice along x, y and z.
struct LatticeBox {
  float low[3], high[3];
};

// A rival hides the seeds that are farther than it from all of a box.
struct Rival {
  float at[3];
  float slack;  // a seed that is farther by less may be as near, by roundings
};

// Some rows and slices of a brick: even numbers of slices, and of rows whole fours.
struct BrickVoxels {
  std::int32_t first[3];  // the first voxel of the brick on the lattice
  std::int32_t step[3];   // along the lattice from one voxel to the next
  std::int32_t first_row, rows;
  std::int32_t first_slice, slices;
  std::ptrdiff_t row, slice;  // elements from one to the next in the output
};

// The seeds that may be nearest, each with what it adds to the key of a voxel by its column, its row and its slice, of
// which the last has the label: 3 brick_side keys.
template <class Key>
struct BrickTerms {
  const Key* terms;
  const std::uint32_t* numbers;  // [count]
  std::int32_t count;
};

// What is written of the keys: labels of those less than `limit`, else 0, or squares.
template <class Key>
struct BrickProduct {
  int label_bits;
  Key limit;
};

template <class Key>
struct BrickKernel {
  // The terms of all voxels of a brick.
  void (*find_terms)(const SeedArrays& seeds, std::int32_t count, const BrickVoxels& voxels, int label_bits,
                     Key* terms);
  // Labels or squares of the nearest, of the rows and slices from these on.
  template <class Voxel>
  using Write = void (*)(const BrickTerms<Key>& seeds, const BrickVoxels& voxels,
                         const BrickProduct<Key>& product, Voxel* out);
  Write<std::uint8_t> labels8;
  Write<std::uint16_t> labels16;
  Write<std::uint32_t> labels32;
  Write<std::uint32_t> squares32;
  Write<std::uint64_t> squares64;
};

struct BrickKernels {
  // The number of a seed that is about the nearest to a place.
  std::int32_t (*near)(const SeedArrays& seeds, std::int32_t count, const float* place);
  // Appends the seeds that a rival does not hide to `kept`, which has `count_kept`; gives the new count.
  std::int32_t (*keep)(const SeedArrays& seeds, std::int32_t count, const LatticeBox& box, const Rival& rival,
                       const SeedArrays& kept, std::int32_t count_kept);
  // The same, but tells the numbers of the seeds.
  std::int32_t (*number)(const SeedArrays& seeds, std::int32_t count, const LatticeBox& box,
                         const Rival& rival, std::uint32_t* numbers);
  // Keys of 32 bits, and of 64.
  BrickKernel<std::uint32_t> narrow;
  BrickKernel<std::uint64_t> wide;
};

BrickKernels brick_kernels(tessellation::Simd level);

namespace kernels {  // one definition a file: brick_kernel_<level>.cpp
BrickKernels bricks_portable();
BrickKernels bricks_avx2();
BrickKernels bricks_avx512();
}  // namespace kernels

}  // namespace vorotool::core::volumes
