#include "core/tessellation/row_sweep.hpp"

#include <algorithm>

namespace vorotool::core::tessellation {

namespace {

// Births are learnt every so many rows. A seed that is born too early is only pruned again on those rows, so
// the step changes the time and never the result; 8 balances the two sweeps (measured for n = 10^4 and 10^6).
constexpr std::int32_t birth_step = 8;

// Entries without a seed that the list may carry along: a quarter of it, and a few.
constexpr std::int32_t idle_entries = 32;

}  // namespace

template <class Arithmetic>
Sweep<Arithmetic>::Sweep(const Sites& sites, const FrameOnLattice& frame, const RowKernel<Arithmetic>& kernel)
    : sites_(sites),
      frame_(frame),
      kernel_(kernel),
      pixels_{frame.width, frame.middle_column(), frame.pixel().x,
              sites.largest_coordinate <= exact_product_bound},
      live_(sites),
      nearest_(sites.column_x.size()) {
  make_envelope();
}

template <class Arithmetic>
void Sweep<Arithmetic>::make_envelope() {
  const std::size_t padded = sites_.column_x.size() + kernel_padding;
  values_ = std::make_unique_for_overwrite<Value[]>(4 * padded);
  numbers_ = std::make_unique_for_overwrite<std::uint32_t[]>(3 * padded);
  indices_ = std::make_unique_for_overwrite<std::int32_t[]>(2 * padded);
  Value* const v = values_.get();
  std::uint32_t* const u = numbers_.get();
  envelope_ = {};
  envelope_.candidates = {v, v + padded, u};
  envelope_.spare = {v + 2 * padded, v + 3 * padded, u + padded};
  envelope_.dead = u + 2 * padded;
  envelope_.end = indices_.get();
  envelope_.ties = indices_.get() + padded;
}

template <class Arithmetic>
void Sweep<Arithmetic>::start(std::int32_t first, std::int32_t last) {
  live_.clear();
  births_.clear();
  offset_ = sites_.count_to(frame_.row_y(first) - frame_.pixel().y);
  follows_.assign(static_cast<std::size_t>(sites_.count_to(frame_.row_y(last)) - offset_),
                  ActiveColumns<Arithmetic>::gone);
  put_nearest_below(frame_.row_y(last));
  learn_births(first, last);
  put_nearest_above(frame_.row_y(first) - frame_.pixel().y);
  next_site_ = offset_;
  first_ = row_ = first;
}

// The nearest seed at or above a line in each column: the first one met going up.
template <class Arithmetic>
void Sweep<Arithmetic>::put_nearest_above(std::int64_t line) {
  std::fill(nearest_.begin(), nearest_.end(), ActiveColumns<Arithmetic>::gone);
  std::size_t missing = nearest_.size();
  for (std::int32_t s = sites_.count_to(line); s > 0 && missing > 0;) {
    std::int32_t& nearest = nearest_[static_cast<std::size_t>(column_of(--s))];
    missing -= nearest < 0;
    nearest = std::max(nearest, s);  // sites are sorted by y: the first one met has the largest number
  }
  put_nearest(
      [&](std::int32_t c, std::int32_t site) { live_.put(c, site, ActiveColumns<Arithmetic>::stays); });
}

// The nearest seed below a line in each column: the first one met going down.
template <class Arithmetic>
void Sweep<Arithmetic>::put_nearest_below(std::int64_t line) {
  std::fill(nearest_.begin(), nearest_.end(), ActiveColumns<Arithmetic>::gone);
  const auto count = static_cast<std::int32_t>(sites_.size());
  std::size_t missing = nearest_.size();
  for (std::int32_t s = sites_.count_to(line); s < count && missing > 0; ++s) {
    std::int32_t& nearest = nearest_[static_cast<std::size_t>(column_of(s))];
    if (nearest >= 0) continue;
    nearest = s;
    --missing;
  }
  put_nearest(
      [&](std::int32_t c, std::int32_t site) { live_.put(c, ActiveColumns<Arithmetic>::stays, site); });
}

// Puts the nearest sites column by column, so that they arrive sorted.
template <class Arithmetic>
template <class Put>
void Sweep<Arithmetic>::put_nearest(Put put) {
  for (std::size_t c = 0; c < nearest_.size(); ++c) {
    if (nearest_[c] >= 0) put(static_cast<std::int32_t>(c), nearest_[c]);
  }
  live_.insert();
}

// Sweeps up from the last row with the seeds below only. Where a seed's cell no longer meets a row, the seed
// is born on the row after it; where a nearer seed of the same column takes over, it is linked behind that
// one.
template <class Arithmetic>
void Sweep<Arithmetic>::learn_births(std::int32_t first, std::int32_t last) {
  auto site = offset_ + static_cast<std::int32_t>(follows_.size());
  live_.link_below(&follows_, offset_);
  drop_dead_below(last);
  for (std::int32_t row = last; row > first;) {
    row = std::max(first, row - birth_step);
    for (const std::int64_t line = frame_.row_y(row); site > 0 && y_of(site - 1) > line;) {
      --site;
      live_.put(column_of(site), ActiveColumns<Arithmetic>::stays, site);
    }
    live_.insert();
    drop_dead_below(row);
  }
  live_.link_below(nullptr, 0);
}

template <class Arithmetic>
void Sweep<Arithmetic>::drop_dead_below(std::int32_t row) {
  prune(row);
  for (std::int32_t k = 0; k < envelope_.dead_count; ++k) {
    births_.push_back({row + 1, live_.below_site(envelope_.dead[k])});
    live_.drop_below(envelope_.dead[k]);
  }
}

// Prunes the candidates of a row, after making the list compact where it carries too much.
template <class Arithmetic>
void Sweep<Arithmetic>::prune(std::int32_t row) {
  const std::int32_t entries = live_.columns().count;
  if (entries - envelope_.collected > entries / 4 + idle_entries) live_.compact();
  kernel_.prune(live_.columns(), static_cast<Coordinate>(frame_.row_y(row)), pixels_, envelope_);
}

template <class Arithmetic>
const Envelope<Arithmetic>& Sweep<Arithmetic>::next_row() {
  const std::int64_t line = frame_.row_y(row_);
  const auto count = static_cast<std::int32_t>(sites_.size());
  // A seed that the sweep reaches stands above from now on; below it waits the one that it had hidden. On the
  // first row the sweep up has ended, and what is below is in place.
  for (; next_site_ < count && y_of(next_site_) <= line; ++next_site_) {
    const std::int32_t hidden = row_ == first_ ? ActiveColumns<Arithmetic>::stays
                                               : follows_[static_cast<std::size_t>(next_site_ - offset_)];
    live_.put(column_of(next_site_), next_site_, hidden);
  }
  for (; !births_.empty() && births_.back().row <= row_; births_.pop_back()) {
    const std::int32_t site = births_.back().site;
    if (y_of(site) > line) live_.put(column_of(site), ActiveColumns<Arithmetic>::stays, site);
  }
  live_.insert();
  prune(row_);
  for (std::int32_t k = 0; k < envelope_.dead_count; ++k) live_.drop_above(envelope_.dead[k]);
  kernel_.bound(pixels_, envelope_);
  ++row_;
  return envelope_;
}

template class Sweep<Narrow>;
template class Sweep<Filtered>;

}  // namespace vorotool::core::tessellation
