// The corners of the pixel lattice at which three or four labels meet (paper, section 2.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "core/label_images/label_runs.hpp"

namespace vorotool::core::label_images {

// The labels of the four pixels around a corner.
struct Corner {
  std::uint32_t upper_left, upper_right, lower_right, lower_left;

  // Three labels with one diagonal of equal labels count as three: 1 2 / 3 1.
  int labels() const {
    const int steps = (upper_left != upper_right) + (upper_right != lower_right) +
                      (lower_right != lower_left) + (lower_left != upper_left);
    if (steps < 4) return steps < 3 ? 1 + steps / 2 : 3;
    return 4 - (upper_left == lower_right) - (upper_right == lower_left);
  }
};

// Walks along two rows of one width.
class RowPair {
 public:
  explicit RowPair(std::size_t width) : above_(width), below_(width) {}

  // Calls stretch(label above, label below) for the longest stretches of columns in which both labels stay,
  // and corner(x, corner) between two stretches, where x is the column on the right.
  template <class Label, class Stretch, class Meet>
  void walk(std::span<const Label> above, std::span<const Label> below, Stretch stretch, Meet corner) {
    below_.cut(above);
    walk_on(above, below, stretch, corner);
  }

  // The same where the row above was the one below in the call before.
  template <class Label, class Stretch, class Meet>
  void walk_on(std::span<const Label> above, std::span<const Label> below, Stretch stretch, Meet corner) {
    std::swap(above_, below_);
    const std::size_t count = above_.size();
    below_.cut(below);
    std::size_t i = 0, j = 0;
    for (;;) {
      const Label left_above = above[above_[i]], left_below = below[below_[j]];
      stretch(std::uint32_t{left_above}, std::uint32_t{left_below});
      const std::uint32_t above_end = above_[i + 1], below_end = below_[j + 1];
      i += above_end <= below_end;
      j += below_end <= above_end;
      if (i == count) return;  // both rows end together
      corner(above_end < below_end ? above_end : below_end,
             Corner{left_above, above[above_[i]], below[below_[j]], left_below});
    }
  }

 private:
  RunStarts above_, below_;
};

}  // namespace vorotool::core::label_images
