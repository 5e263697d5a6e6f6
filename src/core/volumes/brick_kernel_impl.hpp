// The loops of the bricks, written once over what a level tells of its vectors. Everything is a template over a type that
// each file defines for itself, so no two files share an instance.
#pragma once

#include "core/volumes/brick_kernel.hpp"

namespace vorotool::core::volumes {

// Vectors of an element; the compiler makes of their operators what the instruction set has.
template <class Level, class Element>
struct VectorsOf {
  typedef Element Vector __attribute__((vector_size(Level::bytes)));
  typedef Element Loaded __attribute__((vector_size(Level::bytes), aligned(sizeof(Element)), may_alias));
  static constexpr std::int32_t width = Level::bytes / static_cast<std::int32_t>(sizeof(Element));

  static Vector load(const Element* from) { return *reinterpret_cast<const Loaded*>(from); }
  static void store(Element* to, Vector v) { *reinterpret_cast<Loaded*>(to) = v; }
  static Vector lesser(Vector a, Vector b) { return a < b ? a : b; }
};

template <class Level>
struct SeedLoops {
  using Floats = VectorsOf<Level, float>;
  using Words = VectorsOf<Level, std::int32_t>;
  using Vector = typename Floats::Vector;
  static constexpr std::int32_t width = Floats::width;

  static Vector square(Vector v) { return v * v; }

  static std::int32_t near(const SeedArrays& given, std::int32_t count, const float* place) {
    // positive floats are ordered as their bits, of which the lowest make room for the number of the seed
    constexpr std::int32_t numbers = std::int32_t{1} << 14;
    const SeedArrays seeds = given;
    const float x = place[0], y = place[1], z = place[2];
    const std::int32_t most = count < numbers ? count : numbers;
    const typename Words::Vector none = typename Words::Vector{} + 0x7fffffff;
    typename Words::Vector best = none, number{};
    for (std::int32_t lane = 0; lane < width; ++lane) number[lane] = lane;
    for (std::int32_t s = 0; s < most; s += width, number += width) {
      const Vector distance = square(Floats::load(seeds.x + s) - x) + square(Floats::load(seeds.y + s) - y) +
                              square(Floats::load(seeds.z + s) - z);
      const auto bits = reinterpret_cast<typename Words::Vector>(distance);
      best = Words::lesser(best, number < most ? (bits & -numbers) | number : none);
    }
    std::int32_t least = best[0];
    for (std::int32_t lane = 1; lane < width; ++lane) least = best[lane] < least ? best[lane] : least;
    return least & (numbers - 1);
  }

  // How much farther than the rival seeds are at least, along one axis: linear, so least at an end of the box.
  static Vector farther(const float* seeds, float rival, float low, float high) {
    const Vector at = Floats::load(seeds);
    const Vector rise = at - rival;
    const Vector sum = at + rival;
    return Floats::lesser(rise * (sum - 2 * low), rise * (sum - 2 * high));
  }

  // Calls take(mask of those that stay, first) for the seeds, a vector at a time.
  template <class Take>
  static void for_kept(const SeedArrays& seeds, std::int32_t count, const LatticeBox& given_box,
                       const Rival& given_rival, Take take) {
    const LatticeBox box = given_box;
    const Rival rival = given_rival;
    for (std::int32_t s = 0; s < count; s += width) {
      const Vector lead = farther(seeds.x + s, rival.at[0], box.low[0], box.high[0]) +
                          farther(seeds.y + s, rival.at[1], box.low[1], box.high[1]) +
                          farther(seeds.z + s, rival.at[2], box.low[2], box.high[2]);
      std::uint32_t stays = Level::mask(lead <= rival.slack);
      if (count - s < width) stays &= (std::uint32_t{1} << (count - s)) - 1;
      take(stays, s);
    }
  }

  static std::int32_t keep(const SeedArrays& given, std::int32_t count, const LatticeBox& box,
                           const Rival& rival, const SeedArrays& given_kept, std::int32_t kept) {
    const SeedArrays seeds = given;
    const SeedArrays out = given_kept;
    for_kept(seeds, count, box, rival, [&](std::uint32_t stays, std::int32_t s) {
      Level::compress(out.x + kept, stays, seeds.x + s);
      Level::compress(out.y + kept, stays, seeds.y + s);
      Level::compress(out.z + kept, stays, seeds.z + s);
      Level::compress(out.label + kept, stays, seeds.label + s);
      kept += __builtin_popcount(stays);
    });
    return kept;
  }

  static std::int32_t number(const SeedArrays& given, std::int32_t count, const LatticeBox& box,
                             const Rival& rival, std::uint32_t* numbers) {
    std::int32_t kept = 0;
    for_kept(given, count, box, rival, [&](std::uint32_t stays, std::int32_t s) {
      std::uint32_t all[width];
      for (std::int32_t lane = 0; lane < width; ++lane) all[lane] = static_cast<std::uint32_t>(s + lane);
      Level::compress(numbers + kept, stays, all);
      kept += __builtin_popcount(stays);
    });
    return kept;
  }
};

template <class Level, class Key>
struct BrickKernelOn {
  using Keys = VectorsOf<Level, Key>;
  using Vector = typename Keys::Vector;
  static constexpr std::int32_t width = Keys::width;
  static constexpr std::int32_t vectors = brick_side / width;  // of a row
  static_assert(vectors >= 1);

  // The places of the voxels along one axis; like all here modulo 2^bits, as are their squares.
  struct Axis {
    Vector places[vectors];

    Axis(std::int32_t first, std::int32_t step) {
      for (std::int32_t k = 0; k < brick_side; ++k)
        places[k / width][k % width] = static_cast<Key>(first + k * step);
    }

    // Squares of the ways to a seed, shifted to their place in a key, with a label.
    void put_terms(float seed, int label_bits, Key label, Key* terms) const {
      const auto at = static_cast<Key>(static_cast<std::int32_t>(seed));
      for (std::int32_t v = 0; v < vectors; ++v) {
        const Vector way = places[v] - at;
        Keys::store(terms + v * width, ((way * way) << label_bits) | label);
      }
    }
  };

  // Of each of two slices, rows whose keys are in registers together.
  static constexpr std::int32_t rows_at_once = 4;

  static void find_terms(const SeedArrays& given, std::int32_t count, const BrickVoxels& voxels,
                         int label_bits, Key* terms) {
    const SeedArrays seeds = given;
    const Axis x(voxels.first[0], voxels.step[0]);
    const Axis y(voxels.first[1], voxels.step[1]);
    const Axis z(voxels.first[2], voxels.step[2]);
    for (std::int32_t s = 0; s < count; ++s, terms += 3 * brick_side) {
      x.put_terms(seeds.x[s], label_bits, 0, terms);
      y.put_terms(seeds.y[s], label_bits, 0, terms + brick_side);
      z.put_terms(seeds.z[s], label_bits, seeds.label[s], terms + 2 * brick_side);
    }
  }

  // Calls put(keys of a vector, slice, row, column) for all vectors of the voxels.
  template <class Put>
  static void nearest(const BrickTerms<Key>& given, const BrickVoxels& voxels, Put put) {
    const BrickTerms<Key> seeds = given;
    for (std::int32_t z = 0; z < voxels.slices; z += 2) {
      for (std::int32_t y = 0; y < voxels.rows; y += rows_at_once) {
        for (std::int32_t v = 0; v < vectors; ++v) {
          const Key* const of_columns = seeds.terms + v * width;
          const Key* const of_rows = seeds.terms + brick_side + voxels.first_row + y;
          const Key* const of_slices = seeds.terms + 2 * brick_side + voxels.first_slice + z;
          Vector low[rows_at_once], high[rows_at_once];
          for (std::int32_t r = 0; r < rows_at_once; ++r) low[r] = high[r] = Vector{} - 1;
          for (std::int32_t s = 0; s < seeds.count; ++s) {
            const std::size_t at = std::size_t{3 * brick_side} * seeds.numbers[s];
            const Vector column = Keys::load(of_columns + at);
            const Vector of_low = column + of_slices[at];
            const Vector of_high = column + of_slices[at + 1];
            for (std::int32_t r = 0; r < rows_at_once; ++r) {
              const Key of_row = of_rows[at + static_cast<std::size_t>(r)];
              low[r] = Keys::lesser(low[r], of_low + of_row);
              high[r] = Keys::lesser(high[r], of_high + of_row);
            }
          }
          for (std::int32_t r = 0; r < rows_at_once; ++r) put(low[r], z, y + r, v * width);
          for (std::int32_t r = 0; r < rows_at_once; ++r) put(high[r], z + 1, y + r, v * width);
        }
      }
    }
  }

  template <class Voxel>
  static void store(Voxel* out, Vector values) {
    typedef Voxel Narrow __attribute__((vector_size(width * sizeof(Voxel))));
    typedef Voxel Stored
        __attribute__((vector_size(width * sizeof(Voxel)), aligned(sizeof(Voxel)), may_alias));
    *reinterpret_cast<Stored*>(out) = __builtin_convertvector(values, Narrow);
  }

  template <class Label>
  static void labels(const BrickTerms<Key>& seeds, const BrickVoxels& voxels,
                     const BrickProduct<Key>& product, Label* out) {
    const Key mask = static_cast<Key>((std::uint64_t{1} << product.label_bits) - 1);
    const std::ptrdiff_t row = voxels.row, slice = voxels.slice;
    const auto at = [=](std::int32_t z, std::int32_t y, std::int32_t x) {
      return out + z * slice + y * row + x;
    };
    if (product.limit == static_cast<Key>(-1)) {
      nearest(seeds, voxels, [=](Vector keys, std::int32_t z, std::int32_t y, std::int32_t x) {
        store(at(z, y, x), keys & mask);
      });
    } else {
      const Key limit = product.limit;
      nearest(seeds, voxels, [=](Vector keys, std::int32_t z, std::int32_t y, std::int32_t x) {
        store(at(z, y, x), keys < limit ? keys & mask : Vector{});
      });
    }
  }

  template <class Square>
  static void squared_distances(const BrickTerms<Key>& seeds, const BrickVoxels& voxels,
                                const BrickProduct<Key>& product, Square* out) {
    const int bits = product.label_bits;
    const std::ptrdiff_t row = voxels.row, slice = voxels.slice;
    nearest(seeds, voxels, [=](Vector keys, std::int32_t z, std::int32_t y, std::int32_t x) {
      store(out + z * slice + y * row + x, keys >> bits);
    });
  }

  static BrickKernel<Key> table() {
    return {find_terms,
            labels<std::uint8_t>,
            labels<std::uint16_t>,
            labels<std::uint32_t>,
            squared_distances<std::uint32_t>,
            squared_distances<std::uint64_t>};
  }
};

template <class Level>
BrickKernels brick_kernels_of() {
  return {SeedLoops<Level>::near, SeedLoops<Level>::keep, SeedLoops<Level>::number,
          BrickKernelOn<Level, std::uint32_t>::table(), BrickKernelOn<Level, std::uint64_t>::table()};
}

}  // namespace vorotool::core::volumes
