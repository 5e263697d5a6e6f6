// Seeds by the cell of a coarse grid that they are in, for all that may be nearest somewhere in a box.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/volumes/brick_kernel.hpp"
#include "core/volumes/volume_sites.hpp"

namespace vorotool::core::volumes {

// Seeds for the kernels, with coordinates relative to a place.
class SeedList {
 public:
  std::int32_t count = 0;

  // Room for so many more than the count.
  void make_room(std::int64_t more);
  SeedArrays from(std::int32_t first) {
    return {x_.data() + first, y_.data() + first, z_.data() + first, label_.data() + first};
  }

 private:
  std::vector<float> x_, y_, z_;
  std::vector<std::uint32_t> label_;
};

// Places of the lattice, ends included.
struct PlaceBox {
  std::array<std::int64_t, 3> low, high;

  std::array<std::int64_t, 3> middle() const {
    return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
  }
};

class SeedGrid {
 public:
  // Whether keys of 64 bits, and floats, hold what these sites need.
  static bool suits(const VolumeSites& sites);

  // The same for any number of threads.
  SeedGrid(const VolumeSites& volume, const VolumeFrame& frame, unsigned threads);

  // Replaces `list` by the seeds that may be nearest in a box, relative to its middle, and some others; gives how many
  // were looked at.
  std::int64_t gather(const PlaceBox& box, const BrickKernels& kernels, SeedList& list, SeedList& room) const;

  // Whether a box has so many seeds that parts of it are gathered rather than itself.
  bool is_dense(const PlaceBox& box) const;

  int label_bits() const { return label_bits_; }

 private:
  using Cell = std::array<std::int64_t, 3>;

  void choose_cells(std::size_t seeds, const VolumeFrame& frame);
  void fill_layer(std::int64_t layer, std::span<const Site> sites, std::size_t number);
  std::int64_t cell_along(std::size_t axis, std::int64_t place) const;
  template <class Body>
  void for_each_run(const Cell& from, const Cell& to, Body body) const;
  std::array<std::int64_t, 3> place_near(const std::array<std::int64_t, 3>& place) const;

  Cell low_{}, side_{}, count_{};
  std::vector<std::uint32_t> first_;          // [cells + 1]
  base::LargeArray<std::int32_t> x_, y_, z_;  // by cell
  base::LargeArray<std::uint32_t> label_;
  int label_bits_;
};

// The allowance for roundings of kernels where no coordinate is larger.
inline float slack_of(double largest) { return static_cast<float>(largest * largest * 0x1.8p-17); }

}  // namespace vorotool::core::volumes
