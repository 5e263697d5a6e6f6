// The pass over a slab of slices behind VolumeMeasurer; slabs are scanned apart and joined along their seams.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/flat_map.hpp"
#include "core/label_images/region_scan.hpp"
#include "core/tessellation/watch.hpp"
#include "core/volumes/measure_volume.hpp"

namespace vorotool::core::volumes {

// The runs of the rows of a slice, each row with its end mark.
struct SliceRuns {
  std::vector<label_images::Run> runs;
  std::vector<std::size_t> rows;  // where each begins

  bool empty() const { return rows.empty(); }
  std::span<label_images::Run> row(std::size_t y) {
    const std::size_t end = y + 1 < rows.size() ? rows[y + 1] : runs.size();
    return std::span(runs).subspan(rows[y], end - rows[y]);
  }
};

// Calls visit(i, j, columns) for each pair of runs of two rows that have columns in common, from left to right.
template <class Visit>
void for_overlaps(std::span<const label_images::Run> above, std::span<const label_images::Run> below,
                  Visit visit) {
  const std::size_t count = above.size() - 1;
  std::uint32_t x = 0;
  for (std::size_t i = 0, j = 0; i < count;) {
    const std::uint32_t above_end = above[i + 1].start;
    const std::uint32_t below_end = below[j + 1].start;
    const std::uint32_t end = std::min(above_end, below_end);
    visit(i, j, end - x);
    x = end;
    i += above_end == end;
    j += below_end == end;
  }
}

// Regions of consecutive slices. Region numbers are local: 1, 2, ... in order of appearance; 0 is the background.
// Faces of regions are only those on the outside of the volume: the others follow from the interfaces. The faces
// behind the last slice are neither.
class SlabScan {
 public:
  SlabScan(std::size_t width, std::size_t height, std::size_t first_slice);

  // Slices are given from the first without gap.
  template <class Label>
  void add_slice(std::span<const Label> slice, tessellation::Watch& watch);

  std::vector<std::uint32_t> labels;
  std::vector<VolumeRegion> regions;
  std::vector<Interface> interfaces;  // in no order, each pair once; of the background, too
  label_images::ComponentSets components;
  SliceRuns first_slice;
  SliceRuns last_slice;

 private:
  using Run = label_images::Run;

  // What a row shares with the one above and the slice before across the pair of runs k - 1 and k: as a rule,
  // these are the faces that a slanted border has, so the pair is looked up once for all of them, and only where
  // the row above has no such pair.
  struct Boundary {
    std::uint32_t interface;  // unknown, or its index
    std::array<std::uint32_t, 2> faces;
  };
  // An overlap of other runs.
  struct Contact {
    const Run* one;
    const Run* other;
    std::uint32_t length;
    std::size_t axis;
  };
  static constexpr std::uint32_t unknown = UINT32_MAX;

  template <class Label>
  std::span<Run> cut(std::span<const Label> row);
  template <std::size_t Axis>
  void join_row(std::span<const Run> other, std::span<Run> row);
  void join(const Run& other, Run& run);
  void open_components(std::span<Run> row);
  void count_faces(std::span<const Run> row);
  std::uint32_t interface_of(const Run& one, const Run& other);
  void measure(std::span<const Run> row, std::uint32_t y);

  std::size_t width_, height_;
  std::uint32_t z_;
  SliceRuns slice_;  // at hand; last_slice is the one before
  label_images::RunStarts starts_;
  std::vector<Boundary> boundaries_;       // of the row at hand
  std::vector<Boundary> last_boundaries_;  // of the row above
  std::vector<Contact> contacts_;          // of the row at hand
  base::FlatMap numbers_;                  // label -> region number
  base::FlatMap pairs_;                    // border_key -> index of the interface + 1
};

}  // namespace vorotool::core::volumes
