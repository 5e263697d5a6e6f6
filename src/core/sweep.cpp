#include "core/sweep.hpp"

#include <algorithm>

namespace vorotool::core {

namespace {

// Births are learnt every so many rows. A seed that is born too early is only pruned again on those rows, so
// the step changes the time and never the result; 8 balances the two sweeps (measured for n = 10^4 and 10^6).
constexpr std::int32_t birth_step = 8;

void set_bit(std::vector<std::uint64_t>& bits, std::int32_t i) {
  bits[static_cast<std::size_t>(i) / 64] |= std::uint64_t{1} << (i % 64);
}
void clear_bit(std::vector<std::uint64_t>& bits, std::int32_t i) {
  bits[static_cast<std::size_t>(i) / 64] &= ~(std::uint64_t{1} << (i % 64));
}
bool has_bit(const std::vector<std::uint64_t>& bits, std::int32_t i) {
  return bits[static_cast<std::size_t>(i) / 64] >> (i % 64) & 1;
}

}  // namespace

template <class Arithmetic>
Sweep<Arithmetic>::Sweep(const Sites& sites, const FrameOnLattice& frame, const RowKernel<Arithmetic>& kernel)
    : sites_(sites), frame_(frame), kernel_(kernel) {
  const std::size_t count = sites.column_x.size();
  const std::size_t padded = count + kernel_padding;
  const std::size_t words = (count + 63) / 64;
  pixels_ = {frame.width, frame.middle_column(), frame.steps,
             sites.largest_coordinate <= exact_product_bound};
  column_x_.resize(padded);
  std::transform(sites.column_x.begin(), sites.column_x.end(), column_x_.begin(),
                 [](std::int64_t x) { return static_cast<Value>(x); });
  above_y_.resize(padded);
  below_y_.resize(padded);
  above_label_.resize(padded);
  below_label_.resize(padded);
  below_site_.resize(padded);
  above_.resize(words);
  below_.resize(words);
  columns_ = {static_cast<std::int32_t>(count),
              static_cast<std::int32_t>(words),
              column_x_.data(),
              above_y_.data(),
              below_y_.data(),
              above_label_.data(),
              below_label_.data(),
              above_.data(),
              below_.data()};
  values_ = std::make_unique_for_overwrite<Value[]>(4 * padded);
  labels_ = std::make_unique_for_overwrite<std::uint32_t[]>(2 * padded);
  indices_ = std::make_unique_for_overwrite<std::int32_t[]>(5 * padded);
  Value* v = values_.get();
  std::int32_t* i = indices_.get();
  envelope_ = {};
  envelope_.candidates = {v, v + padded, labels_.get(), i};
  envelope_.spare = {v + 2 * padded, v + 3 * padded, labels_.get() + padded, i + padded};
  envelope_.end = i + 2 * padded;
  envelope_.ties = i + 3 * padded;
  envelope_.dead = i + 4 * padded;
}

template <class Arithmetic>
void Sweep<Arithmetic>::start(std::int32_t first, std::int32_t last) {
  const auto count_to = [&](std::int64_t line) {  // seeds at or above a line
    return static_cast<std::int32_t>(std::upper_bound(sites_.y.begin(), sites_.y.end(), line) -
                                     sites_.y.begin());
  };
  clear_columns();
  births_.clear();
  offset_ = count_to(frame_.row_y(first) - frame_.steps);
  next_below_.assign(static_cast<std::size_t>(count_to(frame_.row_y(last)) - offset_), none);
  collect_nearest_below(frame_.row_y(last));
  learn_births(first, last);
  collect_nearest_above(frame_.row_y(first) - frame_.steps);
  next_site_ = offset_;
  first_ = row_ = first;
}

template <class Arithmetic>
void Sweep<Arithmetic>::clear_columns() {
  std::fill(above_.begin(), above_.end(), 0);
  std::fill(below_.begin(), below_.end(), 0);
}

template <class Arithmetic>
void Sweep<Arithmetic>::set_below(std::int32_t column, std::int32_t site) {
  const auto c = static_cast<std::size_t>(column);
  const auto s = static_cast<std::size_t>(site);
  below_y_[c] = static_cast<Coordinate>(sites_.y[s]);
  below_label_[c] = sites_.label[s];
  below_site_[c] = site;
  set_bit(below_, column);
}

// The nearest seed at or above a line in each column: the first one met going up.
template <class Arithmetic>
void Sweep<Arithmetic>::collect_nearest_above(std::int64_t line) {
  auto s =
      static_cast<std::size_t>(std::upper_bound(sites_.y.begin(), sites_.y.end(), line) - sites_.y.begin());
  for (std::int32_t missing = columns_.count; s > 0 && missing > 0;) {
    --s;
    const std::int32_t c = sites_.column[s];
    if (has_bit(above_, c)) continue;
    above_y_[static_cast<std::size_t>(c)] = static_cast<Coordinate>(sites_.y[s]);
    above_label_[static_cast<std::size_t>(c)] = sites_.label[s];
    set_bit(above_, c);
    --missing;
  }
}

// The nearest seed below a line in each column: the first one met going down.
template <class Arithmetic>
void Sweep<Arithmetic>::collect_nearest_below(std::int64_t line) {
  auto s =
      static_cast<std::size_t>(std::upper_bound(sites_.y.begin(), sites_.y.end(), line) - sites_.y.begin());
  for (std::int32_t missing = columns_.count; s < sites_.size() && missing > 0; ++s) {
    if (has_bit(below_, sites_.column[s])) continue;
    set_below(sites_.column[s], static_cast<std::int32_t>(s));
    --missing;
  }
}

// Sweeps up from the last row with the seeds below only. Where a seed's cell no longer meets a row, the seed
// is born on the row after it; where a nearer seed of the same column takes over, it is linked behind that
// one.
template <class Arithmetic>
void Sweep<Arithmetic>::learn_births(std::int32_t first, std::int32_t last) {
  auto site = offset_ + static_cast<std::int32_t>(next_below_.size());
  drop_dead_below(last);
  for (std::int32_t row = last; row > first;) {
    row = std::max(first, row - birth_step);
    for (const std::int64_t line = frame_.row_y(row);
         site > 0 && sites_.y[static_cast<std::size_t>(site - 1)] > line;) {
      --site;
      const std::int32_t column = sites_.column[static_cast<std::size_t>(site)];
      if (has_bit(below_, column)) {
        next_below_[static_cast<std::size_t>(site - offset_)] = below_site_[static_cast<std::size_t>(column)];
      }
      set_below(column, site);
    }
    drop_dead_below(row);
  }
}

template <class Arithmetic>
void Sweep<Arithmetic>::drop_dead_below(std::int32_t row) {
  kernel_.prune(columns_, row_y(row), pixels_, envelope_);
  for (std::int32_t k = 0; k < envelope_.dead_count; ++k) {
    const std::int32_t column = envelope_.dead[k];
    births_.push_back({row + 1, below_site_[static_cast<std::size_t>(column)]});
    clear_bit(below_, column);
  }
}

// A seed that the sweep reaches stands above from now on; below it waits the one that it had hidden.
template <class Arithmetic>
void Sweep<Arithmetic>::arrive(std::int32_t site, bool on_first_row) {
  const auto s = static_cast<std::size_t>(site);
  const std::int32_t column = sites_.column[s];
  above_y_[static_cast<std::size_t>(column)] = static_cast<Coordinate>(sites_.y[s]);
  above_label_[static_cast<std::size_t>(column)] = sites_.label[s];
  set_bit(above_, column);
  if (on_first_row) return;  // the sweep up ended on this row: what is below is in place
  const std::int32_t hidden = next_below_[static_cast<std::size_t>(site - offset_)];
  if (hidden == none) {
    clear_bit(below_, column);
  } else {
    set_below(column, hidden);
  }
}

template <class Arithmetic>
const Envelope<Arithmetic>& Sweep<Arithmetic>::next_row() {
  const std::int64_t line = frame_.row_y(row_);
  const auto count = static_cast<std::int32_t>(sites_.size());
  while (next_site_ < count && sites_.y[static_cast<std::size_t>(next_site_)] <= line) {
    arrive(next_site_++, row_ == first_);
  }
  for (; !births_.empty() && births_.back().row <= row_; births_.pop_back()) {
    const std::int32_t site = births_.back().site;
    if (sites_.y[static_cast<std::size_t>(site)] > line) {
      set_below(sites_.column[static_cast<std::size_t>(site)], site);
    }
  }
  kernel_.prune(columns_, static_cast<Coordinate>(line), pixels_, envelope_);
  for (std::int32_t k = 0; k < envelope_.dead_count; ++k) clear_bit(above_, envelope_.dead[k]);
  kernel_.bound(pixels_, envelope_);
  ++row_;
  return envelope_;
}

template class Sweep<Narrow>;
template class Sweep<Wide>;

}  // namespace vorotool::core
