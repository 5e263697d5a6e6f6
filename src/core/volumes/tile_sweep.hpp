// The nearest seeds of volumes of which every few voxels have one: where cells have few voxels on a row, more of the
// time of SlabSweep goes into which seeds begin and end than into voxels.
//
// Each tile of rows and columns goes through the slices. A plane holds the nearest seed of its own slice at each voxel,
// which a disc around every seed gives; a slice is the least of the planes around it, each raised by the square of its
// distance. A distance that reaches the nearest seeds of nearly all voxels is guessed from the density of seeds: what is
// found within it is nearest, and where nothing is, voxels are looked up one by one, or a larger distance is taken.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/volumes/nearest_kernel.hpp"
#include "core/volumes/seed_tiles.hpp"

namespace vorotool::core::volumes {

// What is written of each voxel. Voxel: uint8, uint16 or uint32 labels, uint32 or uint64 squares.
enum class Product { labels, squares };

template <class Voxel, Product product>
class TileSweep {
 public:
  // Labels of voxels farther than the root of `most_squared` are 0. `out` has the slices of `slices`.
  // `stream` copies past the caches.
  TileSweep(const SeedTiles& tiles, const NearestKernels& kernels,
            void (*stream)(void*, const void*, std::size_t), std::optional<std::int64_t> most_squared,
            Range slices, Voxel* out)
      : tiles_(tiles),
        kernels_(kernels),
        stream_(stream),
        label_bits_(tiles.label_bits()),
        most_squared_(most_squared),
        slices_(slices),
        out_(out) {}

  // Writes a box of at most one tile across and down.
  void write(const Box& box);

 private:
  template <class Key>
  bool write_within(const Box& box, std::int32_t distance, const NearestKernel<Key>& kernel,
                    std::vector<Key>& planes);
  template <class Key>
  void make_plane(const Box& box, std::int32_t distance, std::size_t number, const NearestKernel<Key>& kernel,
                  Key* plane) const;
  template <class Key>
  bool look_up(std::int32_t column, std::int32_t row, std::int32_t slice, std::int32_t count, Key limit,
               Key* keys) const;
  template <class Key>
  void put(const NearestKernel<Key>& kernel, const Key* keys, Voxel* voxels) const;

  std::int64_t largest_square(std::int32_t distance) const;

  const SeedTiles& tiles_;
  const NearestKernels& kernels_;
  void (*const stream_)(void*, const void*, std::size_t);
  const int label_bits_;
  const std::optional<std::int64_t> most_squared_;
  const Range slices_;
  Voxel* const out_;

  std::vector<TileSeed> seeds_;  // within reach of a box, by slices
  std::vector<std::int32_t> first_;
  std::vector<std::uint32_t> narrow_;
  std::vector<std::uint64_t> wide_;
};

}  // namespace vorotool::core::volumes
