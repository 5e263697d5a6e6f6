// The sweep over a slab of slices: which seeds are nearest on each row, and where they meet.
//
// On a row, whose voxels differ in x only, at most one seed a column of equal x matters, and between neighbors a and b
// the seed i is nowhere nearest when (F_b - F_i) (x_i - x_a) < (F_i - F_a) (x_b - x_i). Differences of F are linear in
// the row and the slice: so what hides a seed on one row hides it on a half-plane of rows and slices, whatever becomes
// of a and b. A seed waits outside that half-plane's complement: until a row of this slice, until a slice, or for good.
// A row sees about 1.5 n^(1/3) of n uniform seeds, a slice 1.5 n^(2/3). A slab may start anywhere, from all seeds.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/tessellation/row_kernel.hpp"
#include "core/volumes/coverage.hpp"
#include "core/volumes/sleeping_line.hpp"
#include "core/volumes/volume_sites.hpp"

namespace vorotool::core::volumes {

template <class Arithmetic>
class SlabSweep {
 public:
  using Envelope = tessellation::Envelope<Arithmetic>;

  SlabSweep(const VolumeSites& sites, const Coverage& coverage, const VolumeFrame& frame,
            const tessellation::RowKernel<Arithmetic>& kernel);

  // Prepares slices first ... last of the frame.
  void start(std::int32_t first, std::int32_t last);

  // Goes to the next slice, from first to last; then `next_row` gives the envelopes of its rows.
  void next_slice();
  const Envelope& next_row();

  const tessellation::PixelRow& pixels() const { return pixels_; }

 private:
  using Coordinate = typename Arithmetic::Coordinate;
  using Value = typename Arithmetic::Value;
  using Measure = typename Arithmetic::Integer;  // holds any squared distance

  // How much nearer others are than a seed, in some measure: above 0 where it is hidden, linear in row and slice.
  struct Excess {
    double here, a_row, a_slice;  // rounded, of the right signs
  };

  // The seed that a column has in the list, or the one that waits to be put there.
  struct Column {
    std::int64_t x, y, z;
    std::uint32_t label;
    std::int32_t site = none;
    bool listed = false;
  };
  static constexpr std::int32_t none = -1;

  void make_room();
  void wake_slice();
  void place_in_slice(std::int32_t site);
  void limit_by_reach(std::size_t from, std::size_t to);
  void insert_waiting();
  void contest(std::int32_t site, std::int32_t other);
  void put_aside(std::int32_t site, const Excess& excess);
  void wait_for_row(std::int32_t site, double row);
  void wait_for_slice(std::int32_t site, double slice);
  void file_dead();
  template <class Integer>
  Excess excess_between(const Column& site, const Column& left, const Column& right) const;
  void settle(std::int32_t column, std::int32_t site);
  void rebuild_list();
  void write_entry(std::int32_t entry, std::int32_t column);

  const Site& site_of(std::int32_t site) const { return sites_.sites[static_cast<std::size_t>(site)]; }
  std::int32_t rows() const { return frame_.plane.height; }

  const VolumeSites& sites_;
  const Coverage& coverage_;
  const VolumeFrame frame_;
  const tessellation::RowKernel<Arithmetic> kernel_;
  tessellation::PixelRow pixels_;

  std::vector<Wedge> wedge_;              // [sites]
  std::vector<std::int32_t> last_slice_;  // [sites] within reach
  std::vector<std::int32_t> next_;        // [sites] the next one that waits for the same row or slice
  std::vector<std::int32_t> of_row_;      // [rows] the first site that waits for it
  std::vector<std::int32_t> of_slice_;    // [slices of the slab]
  std::vector<std::int32_t> active_;      // sites that may be nearest in the current slice
  std::vector<std::uint8_t> is_active_;   // [sites]

  std::vector<Column> columns_;
  std::vector<std::int32_t> order_;  // listed columns, increasing
  std::vector<std::int32_t> merged_;
  std::vector<std::int32_t> fresh_;  // columns that are to be listed
  bool is_stale_ = false;            // whether the list is not that of the columns

  std::unique_ptr<Value[]> values_;
  std::unique_ptr<Coordinate[]> coordinates_;
  std::unique_ptr<std::uint32_t[]> numbers_;
  std::unique_ptr<std::int32_t[]> indices_;
  tessellation::ListedSeeds<Arithmetic> list_{};
  std::uint32_t* labels_ = nullptr;  // of the list
  Envelope envelope_{};

  std::int32_t first_ = 0, last_ = 0;
  std::int32_t slice_ = 0, row_ = 0;
  std::int64_t y_ = 0, z_ = 0;  // of the current row
};

extern template class SlabSweep<tessellation::Narrow>;
extern template class SlabSweep<tessellation::Wide>;

}  // namespace vorotool::core::volumes
