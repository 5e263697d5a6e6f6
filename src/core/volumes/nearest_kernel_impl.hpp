// The loops of the tiles, written once; the compiler makes vectors of them. Everything is a template over a type that
// each file defines for itself, so no two files share an instance.
#pragma once

#include "core/volumes/nearest_kernel.hpp"

namespace vorotool::core::volumes {

template <class Level, class Key>
struct NearestKernelOn {
  // The compiler makes of these what the instruction set has.
  typedef Key Keys __attribute__((vector_size(Level::bytes)));
  typedef Key Loaded __attribute__((vector_size(Level::bytes), aligned(sizeof(Key)), may_alias));
  static constexpr std::int32_t width = Level::bytes / static_cast<std::int32_t>(sizeof(Key));
  static_assert(chunk % width == 0);

  static Keys load(const Key* keys) { return *reinterpret_cast<const Loaded*>(keys); }
  static void store(Key* keys, Keys v) { *reinterpret_cast<Loaded*>(keys) = v; }
  static Keys lesser(Keys a, Keys b) { return a < b ? a : b; }
  static Keys greater(Keys a, Keys b) { return a > b ? a : b; }

  static void add_disc(const Disc& disc, Key* plane) {
    const std::int32_t vectors = (disc.columns + width - 1) / width;
    const std::int32_t last = tile_width - vectors * width;
    const std::int32_t column = disc.column < last ? disc.column : last;
    Key* start = plane + disc.row * tile_width + column;
    std::int32_t x = disc.x + (column - disc.column) * disc.step_x;
    for (std::int32_t v = 0; v < vectors; ++v, start += width, x += width * disc.step_x) {
      Keys known;
      for (std::int32_t q = 0; q < width; ++q) known[q] = static_cast<Key>(x + q * disc.step_x);
      known = ((known * known) << disc.label_bits) | disc.label;  // modulo 2^bits
      Key* row = start;
      std::int32_t y = disc.y;
      for (std::int32_t r = 0; r < disc.rows; ++r, row += tile_width, y += disc.step_y) {
        const Key square = (static_cast<Key>(y) * static_cast<Key>(y)) << disc.label_bits;
        store(row, lesser(load(row), known + square));
      }
    }
  }

  static Key merge(const Stack<Key>& stack, std::int32_t offset, Key* keys) {
    constexpr std::int32_t vectors = chunk / width;
    const Key* const* const middle = stack.planes + stack.reach;
    const std::int32_t reach = stack.reach;
    const Key* const squares = stack.square;
    Keys best[vectors];
    for (std::int32_t v = 0; v < vectors; ++v) best[v] = load(middle[0] + offset + v * width);
    for (std::int32_t k = 1;; ++k) {
      if (k > reach) break;
      if (k > 2 && (k & 1) != 0) {
        // what is farther than the nearest one of each voxel changes nothing
        Keys farther = best[0] >= squares[k];
        for (std::int32_t v = 1; v < vectors; ++v) farther |= best[v] >= squares[k];
        if (!Level::any(&farther)) break;
      }
      const Key* const below = middle[-k] + offset;
      const Key* const above = middle[k] + offset;
      const Key square = squares[k];
      for (std::int32_t v = 0; v < vectors; ++v) {
        best[v] = lesser(best[v], lesser(load(below + v * width), load(above + v * width)) + square);
      }
    }
    Keys largest = best[0];
    for (std::int32_t v = 0; v < vectors; ++v) {
      store(keys + v * width, best[v]);
      largest = greater(largest, best[v]);
    }
    Key most = 0;
    for (std::int32_t q = 0; q < width; ++q) most = largest[q] > most ? largest[q] : most;
    return most;
  }

  template <class Label>
  static void labels(const Key* keys, Key limit, Key label_mask, Label* out) {
    for (std::int32_t q = 0; q < chunk; ++q) {
      out[q] = static_cast<Label>(keys[q] < limit ? keys[q] & label_mask : 0);
    }
  }

  template <class Square>
  static void squares(const Key* keys, int label_bits, Square* out) {
    for (std::int32_t q = 0; q < chunk; ++q) out[q] = static_cast<Square>(keys[q] >> label_bits);
  }

  static NearestKernel<Key> table() {
    return {add_disc,
            merge,
            labels<std::uint8_t>,
            labels<std::uint16_t>,
            labels<std::uint32_t>,
            squares<std::uint32_t>,
            squares<std::uint64_t>};
  }
};

template <class Level>
NearestKernels nearest_kernels_of() {
  return {NearestKernelOn<Level, std::uint32_t>::table(), NearestKernelOn<Level, std::uint64_t>::table()};
}

}  // namespace vorotool::core::volumes
