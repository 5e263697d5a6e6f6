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

#include "core/row_kernel.hpp"
#include "core/sites.hpp"

namespace vorotool::core {

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
  static constexpr std::int32_t none = -1;

  // A seed below becomes live on a row; met in order of decreasing row, used in order of increasing row.
  struct Birth {
    std::int32_t row;
    std::int32_t site;
  };

  void clear_columns();
  void collect_nearest_above(std::int64_t line);
  void collect_nearest_below(std::int64_t line);
  void learn_births(std::int32_t first, std::int32_t last);
  void drop_dead_below(std::int32_t row);
  void arrive(std::int32_t site, bool on_first_row);
  void set_below(std::int32_t column, std::int32_t site);
  Coordinate row_y(std::int32_t row) const { return static_cast<Coordinate>(frame_.row_y(row)); }

  const Sites& sites_;
  const FrameOnLattice frame_;
  const RowKernel<Arithmetic> kernel_;
  PixelRow pixels_;

  std::vector<Value> column_x_;
  std::vector<Coordinate> above_y_, below_y_;
  std::vector<std::uint32_t> above_label_, below_label_;
  std::vector<std::uint64_t> above_, below_;
  std::vector<std::int32_t> below_site_;
  Columns<Arithmetic> columns_;

  // Room for the envelope: as many elements as there are columns, of which few are ever touched.
  std::unique_ptr<Value[]> values_;
  std::unique_ptr<std::uint32_t[]> labels_;
  std::unique_ptr<std::int32_t[]> indices_;
  Envelope<Arithmetic> envelope_;

  std::vector<std::int32_t>
      next_below_;  // site - offset_ -> the seed that is live below it in its column, or none
  std::vector<Birth> births_;
  std::int32_t offset_ = 0;
  std::int32_t next_site_ = 0;
  std::int32_t first_ = 0;
  std::int32_t row_ = 0;
};

extern template class Sweep<Narrow>;
extern template class Sweep<Wide>;

}  // namespace vorotool::core
