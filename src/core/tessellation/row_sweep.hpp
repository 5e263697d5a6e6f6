// The row sweep over a band of rows: which seeds are nearest on each row, and where they meet.
//
// A Voronoi cell is convex and contains its site. Going down the rows, once the cell of a seed above the
// current row no longer meets the row, it meets no later row and the seed is dropped for good; likewise going
// up for the seeds below. So a row sees only the seeds whose cells meet it, about 1.6 sqrt(n) of n uniform
// seeds, and a band of rows can start anywhere from two lists: the nearest seed above and below in each
// column.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/tessellation/active_columns.hpp"
#include "core/tessellation/row_kernel.hpp"
#include "core/tessellation/sorted_seeds.hpp"

namespace vorotool::core::tessellation {

template <class Arithmetic>
class Sweep {
 public:
  Sweep(const Sites& sites, const FrameOnLattice& frame, const RowKernel<Arithmetic>& kernel);

  // Prepares rows first ... last of the frame.
  void start(std::int32_t first, std::int32_t last);

  // The envelope of the next row, from first to last.
  const Envelope<Arithmetic>& next_row();

  const PixelRow& pixels() const { return pixels_; }

 private:
  using Coordinate = typename Arithmetic::Coordinate;
  using Value = typename Arithmetic::Value;

  // A seed below becomes live on a row; met in order of decreasing row, used in order of increasing row.
  struct Birth {
    std::int32_t row;
    std::int32_t site;
  };

  void make_envelope();
  void put_nearest_above(std::int64_t line);
  void put_nearest_below(std::int64_t line);
  template <class Put>
  void put_nearest(Put put);
  void learn_births(std::int32_t first, std::int32_t last);
  void drop_dead_below(std::int32_t row);
  void prune(std::int32_t row);
  std::int32_t column_of(std::int32_t site) const { return sites_.column[static_cast<std::size_t>(site)]; }
  std::int64_t y_of(std::int32_t site) const { return sites_.y[static_cast<std::size_t>(site)]; }

  const Sites& sites_;
  const FrameOnLattice frame_;
  const RowKernel<Arithmetic> kernel_;
  PixelRow pixels_;
  ActiveColumns<Arithmetic> live_;

  // Room for the envelope: as many elements as there are columns, of which few are ever touched.
  std::unique_ptr<Value[]> values_;
  std::unique_ptr<std::uint32_t[]> numbers_;
  std::unique_ptr<std::int32_t[]> indices_;
  Envelope<Arithmetic> envelope_;

  std::vector<std::int32_t> nearest_;  // [columns] the nearest site of a column, while a band starts
  // Site - offset_ -> the seed that is live below it in its column, or gone
  std::vector<std::int32_t> follows_;
  std::vector<Birth> births_;
  std::int32_t offset_ = 0;
  std::int32_t next_site_ = 0;
  std::int32_t first_ = 0;
  std::int32_t row_ = 0;
};

extern template class Sweep<Narrow>;
extern template class Sweep<Filtered>;

}  // namespace vorotool::core::tessellation
