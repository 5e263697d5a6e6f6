// The inner loops of the row sweep: one table of functions for each instruction set and number system.
//
// The row kernel files are compiled for wider instruction sets than the rest. They take raw pointers and call
// nothing from the standard library, so that no inline function compiled for a wide machine is linked
// elsewhere.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/tessellation/simd_level.hpp"
#include "core/tessellation/sweep_arithmetic.hpp"

namespace vorotool::core::tessellation {

// Arrays that the kernels read in whole vectors have this many spare elements behind their end.
inline constexpr std::int32_t kernel_padding = 256;

// The live seeds of a sweep: in each column at most one at or above the current row and one below it. A
// column is a distinct x coordinate of the seeds. The list has an entry for every column with a live seed, in
// increasing x, and may have entries that have lost theirs.
template <class Arithmetic>
struct ActiveColumnArrays {
  std::int32_t count;                        // entries
  typename Arithmetic::Value* x;             // [count]
  typename Arithmetic::Coordinate* above_y;  // [count] at most the row; -far: none
  typename Arithmetic::Coordinate* below_y;  // [count] more than the row; far: none
  std::uint32_t* above_label;                // [count]
  std::uint32_t* below_label;                // [count]
  std::uint32_t* nearer_label;               // [count] of the nearer one on the row that was collected last
};

// The live seeds of a sweep through a volume: one in each column.
template <class Arithmetic>
struct ListedSeeds {
  std::int32_t count;
  typename Arithmetic::Value* x;       // [count] increasing
  typename Arithmetic::Value* base;    // [count] x^2 + dz^2
  typename Arithmetic::Coordinate* y;  // [count]
};

// Seeds whose parabolas (x - x_i)^2 + dy_i^2 may be lowest somewhere on the row, in increasing x.
template <class Arithmetic>
struct Candidates {
  typename Arithmetic::Value* x;
  typename Arithmetic::Value* value;  // F = x^2 + dy^2; dy where F is rounded
  std::uint32_t* entry;               // of the live columns
};

// How pixels lie on the lattice: pixel p of a row is at x = steps * (p - middle).
struct PixelRow {
  std::int32_t width;
  std::int32_t middle;
  std::int64_t steps;
  bool products_exact;  // equal rounded products are equal products (see sweep_arithmetic.hpp)
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
  std::uint32_t* dead;  // [dead_count] entries whose candidate is nowhere nearest on this row
  std::int32_t dead_count;
  std::uint32_t* dead_left;   // [dead_count] the entries that each lay between then; `list` alone writes them
  std::uint32_t* dead_right;  // [dead_count]
  std::int32_t collected;     // entries that had a seed
  const std::uint32_t* nearer_label;  // [entries]

  std::uint32_t label_of(std::int32_t i) const { return nearer_label[candidates.entry[i]]; }
};

template <class Arithmetic>
struct RowKernel {
  // Collects the nearer seed of each column, then drops those that are nowhere nearest on the row.
  // Takes out the seeds above that a nearer seed below hides for good.
  void (*prune)(const ActiveColumnArrays<Arithmetic>&, typename Arithmetic::Coordinate row, const PixelRow&,
                Envelope<Arithmetic>&);
  // The same for a list: all candidates are taken from it, and what hides each dead one is told. `nearer_label` is the
  // list's own. Null for Filtered: volumes are Narrow or Wide.
  void (*list)(const ListedSeeds<Arithmetic>&, typename Arithmetic::Coordinate row, const PixelRow&,
               Envelope<Arithmetic>&);
  // Fills end and ties of a pruned envelope.
  void (*bound)(const PixelRow&, Envelope<Arithmetic>&);
  // Writes labels over a row; up to 192 bytes behind its end are overwritten.
  void (*fill8)(const Envelope<Arithmetic>&, std::uint8_t* row);
  void (*fill16)(const Envelope<Arithmetic>&, std::uint16_t* row);
  void (*fill32)(const Envelope<Arithmetic>&, std::uint32_t* row);
  // Copies past the caches; `fence` orders these writes before what follows.
  void (*stream)(void* target, const void* source, std::size_t bytes);
  void (*fence)();
};

RowKernel<Narrow> narrow_kernel(Simd level);
RowKernel<Filtered> filtered_kernel(Simd level);
RowKernel<Wide> wide_kernel();

// Calls body(kernel) with the narrow kernel or, where the sites need it, with the other one.
template <class Wider, class Body>
void with_kernel(bool wide, const RowKernel<Wider>& wider, Simd level, Body body) {
  if (wide) {
    body(wider);
  } else {
    body(narrow_kernel(level));
  }
}

namespace kernels {  // one definition a file: row_kernel_<level>.cpp
RowKernel<Narrow> portable();
RowKernel<Narrow> avx2();
RowKernel<Narrow> avx512();
RowKernel<Filtered> filtered_portable();
RowKernel<Filtered> filtered_avx2();
}  // namespace kernels

}  // namespace vorotool::core::tessellation
