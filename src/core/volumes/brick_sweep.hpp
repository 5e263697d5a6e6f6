// The nearest seeds of a volume brick by brick.
//
// In a box, a seed that another one is nearer than at every corner is nearer nowhere: half-spaces are convex. So boxes
// are halved, each with those of the seeds of the one around it that the seed nearest to its middle does not hide, until
// few are left for a brick, where each voxel takes the least of all distances. Tests against one seed are sums and
// products, and so is the rest: both are quick on whole vectors.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "core/volumes/brick_kernel.hpp"
#include "core/volumes/seed_grid.hpp"

namespace vorotool::core::volumes {

// What is written of each voxel. Labels: uint8, uint16 or uint32; squares: uint32 or uint64; distances are the roots of
// such squares, as floats.
enum class Product { labels, squares, distances };

template <class Voxel, Product product>
using Written = std::conditional_t<product == Product::distances, float, Voxel>;

// Labels of voxels farther than the root of `most_squared` are 0. Distances are roots of squares times `square_of_step`.
struct BrickMeasure {
  std::optional<std::int64_t> most_squared = {};
  double square_of_step = 1;
};

inline float distance_of(double square, double square_of_step) {
  return static_cast<float>(std::sqrt(square * square_of_step));
}

// Voxels along the sides of the boxes that bricks are found in.
inline constexpr std::int32_t block_side = 32;

// A part of a volume: all voxels of some rows of some slices, ends included.
struct Rows {
  std::int32_t first_row, last_row, first_slice, last_slice;
};

// The seeds of the bricks of a block of rows and slices.
class BrickSeeds {
 public:
  BrickSeeds(const SeedGrid& grid, const VolumeFrame& frame, const BrickKernels& kernels);

  // Finds those of the boxes, of two bricks along each side, of a block.
  void start(const Rows& rows);

  struct Brick {
    SeedArrays seeds;
    std::int32_t count;
    std::int32_t first[3];  // its first voxel on the lattice of the seeds
    LatticeBox box;
    Rival rival;
    double largest_square;  // no distance to one of them has a larger one
  };
  // Of the brick with a number along each axis, from the first one of the block.
  Brick brick(std::int32_t x, std::int32_t y, std::int32_t z);
  // Numbers of those of its seeds that half its rows and slices, from these on, may have; gives how many.
  std::int32_t number_part(const Brick& whole, std::int32_t row, std::int32_t slice, std::uint32_t* numbers);

  // About how many nanoseconds a voxel takes, of the voxels of some slices.
  double nanoseconds_a_voxel(std::int32_t first, std::int32_t slices);

 private:
  // Seeds number first ... first + count - 1 of `listed_`, relative to a place.
  struct BoxSeeds {
    std::int32_t first, count;
    std::array<std::int64_t, 3> origin;
    float slack;  // of rivals
    double largest_square;
  };
  using Voxel = std::array<std::int32_t, 3>;

  PlaceBox places(const Voxel& first, std::int32_t side) const;
  void divide(const Voxel& first);
  BoxSeeds& box_at(const Voxel& first);
  double widest(const LatticeBox& box, SeedList& list) const;
  Rival rival_in(const SeedArrays& seeds, std::int32_t count, const LatticeBox& box) const;
  double largest_square(const BoxSeeds& of, const PlaceBox& box);

  const SeedGrid& grid_;
  const BrickKernels kernels_;
  const Voxel size_, step_;
  Voxel start_{};
  std::int32_t across_ = 0;  // boxes
  std::vector<BoxSeeds> boxes_;
  SeedList listed_, block_, room_, found_;
  std::int64_t looked_at_ = 0;
};

template <class Voxel, Product product>
class BrickSweep {
 public:
  using Out = Written<Voxel, product>;

  // `out` begins with slice `first`. `stream` copies past the caches.
  BrickSweep(const SeedGrid& grid, const VolumeFrame& frame, const BrickKernels& kernels,
             void (*stream)(void*, const void*, std::size_t), const BrickMeasure& measure, std::int32_t first,
             Out* out);

  // Writes a block of rows: `block_side` of them and as many slices at most.
  void write(const Rows& rows);

 private:
  void write_row(const Voxel* row, Out* to);
  void fill_bar(std::int32_t y, std::int32_t z);
  void fill_brick(const BrickSeeds::Brick& brick, Voxel* to);
  template <class Key>
  void fill_with(const BrickSeeds::Brick& brick, const BrickKernel<Key>& kernel, std::vector<Key>& terms,
                 Voxel* to);

  BrickSeeds seeds_;
  const VolumeFrame frame_;
  const BrickKernels kernels_;
  void (*const stream_)(void*, const void*, std::size_t);
  const BrickMeasure measure_;
  const int label_bits_;
  const std::int32_t first_;
  Out* const out_;
  const std::ptrdiff_t row_;  // elements of a row of `bar_`
  std::vector<Voxel> bar_;    // a brick's rows and slices
  std::vector<Out> roots_;    // of a row
  std::vector<std::uint32_t> numbers_, part_;
  std::vector<std::uint32_t> narrow_;
  std::vector<std::uint64_t> wide_;
};

}  // namespace vorotool::core::volumes
