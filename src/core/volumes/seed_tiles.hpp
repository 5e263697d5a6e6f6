// Seeds by the tile of rows and columns that they are in, for volumes of which every few voxels have one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/volumes/volume_sites.hpp"

namespace vorotool::core::volumes {

struct TileSeed {
  std::int32_t x, y;   // on the lattice
  std::int32_t slice;  // of the frame, or before or after it
  std::uint32_t label;
};

// A nearest seed: a square on the lattice, and the smallest label at that distance.
struct Nearest {
  std::int64_t square;
  std::uint32_t label;
};

// Slices that a tile goes through at a time.
inline constexpr std::int32_t box_slices = 128;

// Voxels first ... last along an axis.
struct Range {
  std::int32_t first, last;

  std::int32_t count() const { return last - first + 1; }
};

struct Box {
  Range columns, rows, slices;

  double voxels() const { return double{1} * columns.count() * rows.count() * slices.count(); }
};

// Part k of those of so many voxels that a range is cut into.
inline Range part_of(Range whole, std::int32_t part, std::int32_t voxels) {
  const std::int32_t first = whole.first + part * voxels;
  return {first, whole.last - first < voxels ? whole.last : first + voxels - 1};
}
inline std::int32_t count_parts(Range whole, std::int32_t voxels) { return (whole.count() - 1) / voxels + 1; }

class SeedTiles {
 public:
  // Whether all seeds lie on slices of the frame, or of the frame without end, near enough for keys of 64 bits.
  static bool suits(const VolumeSites& sites, const VolumeFrame& frame);

  // Sites in the order of prepare_sites.
  SeedTiles(std::span<const Site> sites, const VolumeFrame& frame);

  // Replaces `found` by the seeds within a distance of a box along each axis, by slices; first[k] is the first one of
  // slice number k from the lowest within reach, up to one after the last.
  void gather(const Box& box, std::int32_t distance, std::vector<TileSeed>& found,
              std::vector<std::int32_t>& first) const;

  // The distance that few voxels of a box are farther from their nearest seed than, if seeds are spread evenly.
  double likely_reach(const Box& box) const;

  // About how many nanoseconds TileSweep takes for a voxel, within a distance.
  double nanoseconds_a_voxel(Range slices, double most_distance) const;

  Nearest nearest(std::int32_t column, std::int32_t row, std::int32_t slice) const;

  const VolumeFrame& frame() const { return frame_; }
  Range columns() const { return {0, frame_.plane.width - 1}; }
  Range rows() const { return {0, frame_.plane.height - 1}; }
  int label_bits() const { return label_bits_; }
  std::int32_t x_of(std::int32_t column) const { return step_x_ * (column - frame_.plane.middle_column()); }
  std::int32_t y_of(std::int32_t row) const { return step_y_ * (row - frame_.plane.middle_row()); }

 private:
  std::int32_t tile_across(std::int64_t x) const;
  std::int32_t tile_down(std::int64_t y) const;
  std::span<const TileSeed> of_tile(std::int32_t across, std::int32_t down) const;

  const VolumeFrame frame_;
  std::int32_t step_x_, step_y_, step_z_;
  std::int32_t across_, down_;  // tiles
  int label_bits_;
  std::vector<std::uint32_t> first_;  // [tiles + 1]
  std::vector<TileSeed> seeds_;       // by tile, then by slice
};

}  // namespace vorotool::core::volumes
