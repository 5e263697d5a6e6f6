#include "core/components.hpp"

#include <algorithm>
#include <vector>

#include "core/label_runs.hpp"
#include "core/region_scan.hpp"

namespace vorotool::core {
namespace {

// A run of ones in a row: the columns [start, end).
struct Stretch {
  std::uint32_t start;
  std::uint32_t end;
  std::uint32_t component;
};

class Scan {
 public:
  Scan(std::size_t width, Connectivity connectivity)
      : starts_(width), reach_(connectivity == Connectivity::eight ? 1 : 0) {}

  // Rows come from the top. Each one gets provisional numbers, which are those of `sets` plus 1.
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
      std::fill(numbers.begin() + start, numbers.begin() + end, component + 1);
      row_.push_back({start, end, component});
    }
  }

  ComponentSets sets;

 private:
  // The component of a run that ends at `end`: that of the runs above which it touches, from `first` on.
  std::uint32_t joined(std::size_t first, std::uint32_t end) {
    if (first == above_.size() || above_[first].start >= end + reach_) return sets.add();
    const std::uint32_t component = above_[first].component;
    for (++first; first < above_.size() && above_[first].start < end + reach_; ++first) {
      sets.unite(component, above_[first].component);
    }
    return component;
  }

  RunStarts starts_;
  std::uint32_t reach_;
  std::vector<Stretch> above_, row_;
};

// The number of each provisional one, and how many there are. The smallest of a set is that of the
// component's first pixel, as no run above has it.
std::uint32_t number_sets(ComponentSets& sets, std::vector<std::uint32_t>& number) {
  number.assign(std::size_t{sets.size()} + 1, 0);
  std::uint32_t count = 0;
  for (std::uint32_t k = 0; k < sets.size(); ++k) {
    const std::uint32_t smallest = sets.find(k);
    number[k + 1] = smallest == k ? ++count : number[smallest + 1];
  }
  return count;
}

void report(const Monitor& monitor, std::size_t done, std::size_t all) {
  if (monitor && !monitor(static_cast<double>(done) / static_cast<double>(all))) throw Interrupted();
}

}  // namespace

std::uint32_t label_components(std::span<const std::uint8_t> mask, std::size_t width,
                               Connectivity connectivity, std::span<std::uint32_t> numbers,
                               const Monitor& monitor) {
  if (mask.empty()) return 0;
  Scan scan(width, connectivity);
  const std::size_t piece = rows_per_piece(width) * width;
  for (std::size_t row = 0; row < mask.size(); row += width) {
    if (row % piece == 0) report(monitor, row, mask.size());
    scan.add_row(mask.subspan(row, width), numbers.subspan(row, width));
  }
  std::vector<std::uint32_t> number;
  const std::uint32_t count = number_sets(scan.sets, number);
  for (std::size_t start = 0; start < mask.size(); start += piece) {
    report(monitor, mask.size(), mask.size());
    for (std::uint32_t& each : numbers.subspan(start, std::min(piece, mask.size() - start)))
      each = number[each];
  }
  return count;
}

}  // namespace vorotool::core
