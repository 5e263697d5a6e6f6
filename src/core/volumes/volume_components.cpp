#include "core/volumes/volume_components.hpp"

#include <algorithm>

namespace vorotool::core::volumes {

using base::Monitor;
using label_images::no_component;

VolumeComponents::VolumeComponents(std::size_t width, std::size_t height, Connectivity connectivity)
    : width_(width),
      height_(height),
      reach_(connectivity == Connectivity::twenty_six ? 1 : 0),
      starts_(width),
      before_{{}, std::vector<std::size_t>(height + 1, 0)},
      slice_{{}, {0}} {}

void VolumeComponents::add(std::span<const std::uint8_t> mask, std::span<std::uint32_t> provisional,
                           const Monitor& monitor) {
  const std::size_t piece = label_images::rows_per_piece(width_) * width_;
  for (std::size_t row = 0; row < mask.size(); row += width_) {
    if (row % piece == 0) base::report(monitor, static_cast<double>(row) / static_cast<double>(mask.size()));
    add_row(mask.subspan(row, width_), provisional.subspan(row, width_));
  }
}

void VolumeComponents::add_row(std::span<const std::uint8_t> row, std::span<std::uint32_t> numbers) {
  if (slice_.rows.size() > height_) {
    std::swap(before_, slice_);
    slice_.runs.clear();
    slice_.rows.assign(1, 0);
  }
  cut(row);
  const std::size_t y = slice_.rows.size() - 1;
  const auto row_of = [](Slice& slice, std::size_t at) {
    return std::span(slice.runs).subspan(slice.rows[at], slice.rows[at + 1] - slice.rows[at]);
  };
  slice_.rows.push_back(slice_.runs.size());
  const auto runs = row_of(slice_, y);
  for (std::size_t at = y - std::min<std::size_t>(y, reach_);
       at <= std::min<std::size_t>(y + reach_, height_ - 1); ++at) {
    join(row_of(before_, at), runs);
  }
  if (y > 0) join(row_of(slice_, y - 1), runs);
  std::fill(numbers.begin(), numbers.end(), 0);
  for (Stretch& run : runs) {
    if (run.component == no_component) run.component = sets_.add();
    std::fill(numbers.begin() + run.start, numbers.begin() + run.end, run.component + 1);
  }
}

// Appends the runs of ones of a row to those of the slice.
void VolumeComponents::cut(std::span<const std::uint8_t> row) {
  const std::size_t count = starts_.cut(row);
  for (std::size_t k = 0; k < count; ++k) {
    if (row[starts_[k]] != 0) slice_.runs.push_back({starts_[k], starts_[k + 1], no_component});
  }
}

// Joins the runs of a row with those of an earlier row that they touch.
void VolumeComponents::join(std::span<const Stretch> earlier, std::span<Stretch> runs) {
  std::size_t first = 0;
  for (Stretch& run : runs) {
    while (first < earlier.size() && earlier[first].end + reach_ <= run.start) ++first;
    for (std::size_t k = first; k < earlier.size() && earlier[k].start < run.end + reach_; ++k) {
      if (run.component == no_component) {
        run.component = earlier[k].component;
      } else {
        sets_.unite(run.component, earlier[k].component);
      }
    }
  }
}

}  // namespace vorotool::core::volumes
