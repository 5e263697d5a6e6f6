// Rows of a label image as maximal runs of equal labels.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vorotool::core::label_images {

// Where the runs of one row start, then the width: run k covers the columns [starts[k], starts[k + 1]).
// A row of 2^32 - 1 pixels is the longest.
class RunStarts {
 public:
  explicit RunStarts(std::size_t width) : starts_(width + 1) {}

  // Cuts `row`, which has the width given to the constructor and is not empty. Returns the number of runs.
  template <class Label>
  std::size_t cut(std::span<const Label> row) {
    count_ = 1;  // starts_[0] is 0 for good
    std::size_t x = 1;
    for (; x + block_size <= row.size(); x += block_size) {
      // Most blocks lie inside a run: one vectorised comparison skips them.
      Label difference = 0;
      for (std::size_t k = x; k < x + block_size; ++k) difference |= row[k] ^ row[k - 1];
      if (difference != 0) mark(row, x, x + block_size);
    }
    mark(row, x, row.size());
    starts_[count_] = static_cast<std::uint32_t>(row.size());
    return count_;
  }

  std::size_t size() const { return count_; }
  std::uint32_t operator[](std::size_t run) const { return starts_[run]; }

 private:
  static constexpr std::size_t block_size = 16;

  // Without a branch: a start is written always and kept when the label changes.
  template <class Label>
  void mark(std::span<const Label> row, std::size_t from, std::size_t to) {
    for (std::size_t x = from; x < to; ++x) {
      starts_[count_] = static_cast<std::uint32_t>(x);
      count_ += row[x] != row[x - 1];
    }
  }

  std::vector<std::uint32_t> starts_;
  std::size_t count_ = 0;
};

// Rows a piece of parallel work: about 2^19 pixels take a few milliseconds, of noise a tenth of
// a second: short enough to interrupt.
constexpr std::size_t rows_per_piece(std::size_t width) {
  constexpr std::size_t piece_pixels = std::size_t{1} << 19;
  return std::max<std::size_t>(1, piece_pixels / std::max<std::size_t>(1, width));
}

}  // namespace vorotool::core::label_images
