// The pass over the rows of a mask that finds which runs of ones hang together.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/label_images/connected_components.hpp"
#include "core/label_images/label_runs.hpp"

namespace vorotool::core::label_images {

// Sets has add(), which gives the component of a run that no run above touches, and unite(one, other), for
// those that a run joins.
template <class Sets>
class ComponentScan {
 public:
  ComponentScan(std::size_t width, Connectivity connectivity, Sets& sets)
      : starts_(width), reach_(connectivity == Connectivity::eight ? 1 : 0), sets_(sets) {}

  // Begins below a row of which the components are known; 0 is background.
  void begin_below(std::span<const std::uint32_t> numbers) {
    row_.clear();
    const std::size_t runs = starts_.cut(numbers);
    for (std::size_t k = 0; k < runs; ++k) {
      const std::uint32_t component = numbers[starts_[k]];
      if (component != 0) row_.push_back({starts_[k], starts_[k + 1], component});
    }
  }

  // Rows come from the top. Each of its ones gets its component, zeros get 0.
  void add_row(std::span<const std::uint8_t> row, std::span<std::uint32_t> numbers) {
    above_.swap(row_);
    row_.clear();
    const std::size_t runs = starts_.cut(row);
    std::size_t first = 0;
    for (std::size_t k = 0; k < runs; ++k) {
      const std::uint32_t start = starts_[k], end = starts_[k + 1];
      if (row[start] == 0) {
        std::fill(numbers.begin() + start, numbers.begin() + end, 0);
        continue;
      }
      while (first < above_.size() && above_[first].end + reach_ <= start) ++first;
      const std::uint32_t component = joined(first, end);
      std::fill(numbers.begin() + start, numbers.begin() + end, component);
      row_.push_back({start, end, component});
    }
  }

 private:
  // A run of ones in a row: the columns [start, end).
  struct Stretch {
    std::uint32_t start;
    std::uint32_t end;
    std::uint32_t component;
  };

  // The component of a run that ends at `end`: that of the runs above which it touches, from `first` on.
  std::uint32_t joined(std::size_t first, std::uint32_t end) {
    if (first == above_.size() || above_[first].start >= end + reach_) return sets_.add();
    const std::uint32_t component = above_[first].component;
    for (++first; first < above_.size() && above_[first].start < end + reach_; ++first) {
      sets_.unite(component, above_[first].component);
    }
    return component;
  }

  RunStarts starts_;
  std::uint32_t reach_;
  Sets& sets_;
  std::vector<Stretch> above_, row_;
};

}  // namespace vorotool::core::label_images
