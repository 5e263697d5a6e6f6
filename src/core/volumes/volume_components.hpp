// Connected components of a mask that passes by in slabs of slices: memory grows with the components and the runs of a
// slice, not with the depth. Provisional numbers are given at once, and which of them are one is known at the end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/label_images/label_runs.hpp"
#include "core/label_images/region_scan.hpp"

namespace vorotool::core::volumes {

enum class Connectivity { six, twenty_six };  // voxels hang together by faces, or by edges and corners, too

class VolumeComponents {
 public:
  VolumeComponents(std::size_t width, std::size_t height, Connectivity connectivity);

  // The next slices of a mask of zeros and ones. Ones get provisional numbers from 1, in raster order of the runs that
  // no earlier run touches. Throws std::length_error beyond 2^32 - 2 of them.
  void add(std::span<const std::uint8_t> mask, std::span<std::uint32_t> provisional,
           const base::Monitor& monitor);

  std::size_t width() const { return width_; }
  std::size_t height() const { return height_; }
  // How many provisional components there are so far.
  std::uint32_t size() const { return sets_.size(); }

  // The number of each provisional component, from 1 in raster order of the first voxels; [0] is 0. It has size() + 1
  // elements. Returns how many components there are. No slices can be added after that.
  std::uint32_t settle(std::span<std::uint32_t> number) { return sets_.settle(number); }

 private:
  // A run of ones in a row: the columns [start, end).
  struct Stretch {
    std::uint32_t start;
    std::uint32_t end;
    std::uint32_t component;  // from 0; no_component until it is known
  };

  // The runs of a slice: those of row y are [rows[y], rows[y + 1]).
  struct Slice {
    std::vector<Stretch> runs;
    std::vector<std::size_t> rows;
  };

  void add_row(std::span<const std::uint8_t> row, std::span<std::uint32_t> numbers);
  void cut(std::span<const std::uint8_t> row);
  void join(std::span<const Stretch> earlier, std::span<Stretch> runs);

  std::size_t width_, height_;
  std::uint32_t reach_;
  label_images::RunStarts starts_;
  label_images::ComponentSets sets_;
  Slice before_, slice_;  // the slice before the one at hand, and this one as far as it is read
};

}  // namespace vorotool::core::volumes
