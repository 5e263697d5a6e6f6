// The inner loops of the row sweep: one table of functions for each instruction set and number system.
//
// The row kernel files are compiled for wider instruction sets than the rest. They take raw pointers and call
// nothing from the standard library, so that no inline function compiled for a wide machine is linked
// elsewhere.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/arithmetic.hpp"
#include "core/simd.hpp"

namespace vorotool::core {

// Arrays that the kernels read in whole vectors have this many spare elements behind their end.
inline constexpr std::int32_t kernel_padding = 64;

// The live seeds of a sweep: at most one at or above the current row and one below it in each column.
// A column is a distinct x coordinate of the seeds; columns are in increasing x.
template <class Arithmetic>
struct Columns {
  std::int32_t count;                        // columns
  std::int32_t words;                        // 64-bit words of each bit set, ceil(count / 64)
  const typename Arithmetic::Value* x;       // [count] increasing
  typename Arithmetic::Coordinate* above_y;  // [count] valid where the bit in `above` is set; y <= row
  typename Arithmetic::Coordinate* below_y;  // [count] valid where the bit in `below` is set; y > row
  std::uint32_t* above_label;                // [count]
  std::uint32_t* below_label;                // [count]
  std::uint64_t* above;  // [words] bit c % 64 of word c / 64: column c has a live seed above
  std::uint64_t* below;  // [words]
};

// Seeds whose parabolas (x - x_i)^2 + dy_i^2 may be lowest somewhere on the row, in increasing x.
template <class Arithmetic>
struct Candidates {
  typename Arithmetic::Value* x;
  typename Arithmetic::Value* value;  // F = x^2 + dy^2
  std::uint32_t* label;
  std::int32_t* column;
};

// How pixels lie on the lattice: pixel p of a row is at x = steps * (p - middle).
struct PixelRow {
  std::int32_t width;
  std::int32_t middle;
  std::int32_t steps;
  bool products_exact;  // equal rounded products are equal products (see arithmetic.hpp)
};

// The lower envelope of a row. Candidate i is nearest on pixels end[i - 1] + 1 ... end[i]; an integer
// boundary (two candidates at the same distance from a pixel) ends the left one there and is listed in
// `ties`.
template <class Arithmetic>
struct Envelope {
  std::int32_t count;
  Candidates<Arithmetic> candidates;
  Candidates<Arithmetic> spare;  // the rounds of pruning write from one to the other
  std::int32_t* end;             // [count] -1 ... width - 1, not decreasing; the last is width - 1
  std::int32_t* ties;            // [tie_count] i: candidates i and i + 1 are equally near to pixel end[i]
  std::int32_t tie_count;
  std::int32_t* dead;  // [dead_count] columns whose candidate is nowhere nearest on this row
  std::int32_t dead_count;
};

template <class Arithmetic>
struct RowKernel {
  // Collects the nearer seed of each column, then drops those that are nowhere nearest on the row.
  // Clears `above` bits of seeds that a nearer seed below hides for good.
  void (*prune)(Columns<Arithmetic>&, typename Arithmetic::Coordinate row, const PixelRow&,
                Envelope<Arithmetic>&);
  // Fills end and ties of a pruned envelope.
  void (*bound)(const PixelRow&, Envelope<Arithmetic>&);
  // Writes labels over a row; up to 64 bytes behind its end are overwritten.
  void (*fill8)(const Envelope<Arithmetic>&, std::uint8_t* row);
  void (*fill16)(const Envelope<Arithmetic>&, std::uint16_t* row);
  void (*fill32)(const Envelope<Arithmetic>&, std::uint32_t* row);
  // Copies past the caches; `fence` orders these writes before what follows.
  void (*stream)(void* target, const void* source, std::size_t bytes);
  void (*fence)();
};

RowKernel<Narrow> narrow_kernel(Simd level);
RowKernel<Wide> wide_kernel();

namespace kernels {  // one definition a file: row_kernel_<level>.cpp
RowKernel<Narrow> portable();
RowKernel<Narrow> avx2();
RowKernel<Narrow> avx512();
}  // namespace kernels

}  // namespace vorotool::core
