#include "core/volumes/slab_sweep.hpp"

#include <algorithm>
#include <cmath>

namespace vorotool::core::volumes {

using numbers::int128;
using tessellation::kernel_padding;
using tessellation::PixelRow;
using tessellation::RowKernel;

template <class Arithmetic>
SlabSweep<Arithmetic>::SlabSweep(const VolumeSites& sites, const Coverage& coverage, const VolumeFrame& frame,
                                 const RowKernel<Arithmetic>& kernel)
    : sites_(sites),
      coverage_(coverage),
      frame_(frame),
      kernel_(kernel),
      pixels_{frame.plane.width, frame.plane.middle_column(), frame.plane.pixel().x,
              sites.largest_coordinate <= exact_product_bound},
      wedge_(sites.sites.size()),
      last_slice_(sites.sites.size()),
      next_(sites.sites.size()),
      of_row_(static_cast<std::size_t>(frame.plane.height), none),
      is_active_(sites.sites.size()),
      columns_(static_cast<std::size_t>(sites.columns)) {
  make_room();
}

template <class Arithmetic>
void SlabSweep<Arithmetic>::make_room() {
  const std::size_t padded = static_cast<std::size_t>(sites_.columns) + kernel_padding;
  values_ = std::make_unique_for_overwrite<Value[]>(6 * padded);
  coordinates_ = std::make_unique_for_overwrite<Coordinate[]>(padded);
  numbers_ = std::make_unique_for_overwrite<std::uint32_t[]>(6 * padded);
  indices_ = std::make_unique_for_overwrite<std::int32_t[]>(2 * padded);
  Value* const v = values_.get();
  std::uint32_t* const u = numbers_.get();
  envelope_.candidates = {v, v + padded, u};
  envelope_.spare = {v + 2 * padded, v + 3 * padded, u + padded};
  envelope_.dead = u + 2 * padded;
  envelope_.dead_left = u + 3 * padded;
  envelope_.dead_right = u + 4 * padded;
  envelope_.end = indices_.get();
  envelope_.ties = indices_.get() + padded;
  list_ = {0, v + 4 * padded, v + 5 * padded, coordinates_.get()};
  labels_ = u + 5 * padded;
  envelope_.nearer_label = labels_;
}

template <class Arithmetic>
void SlabSweep<Arithmetic>::start(std::int32_t first, std::int32_t last) {
  first_ = first;
  last_ = last;
  slice_ = first - 1;
  of_slice_.assign(static_cast<std::size_t>(last - first) + 1, none);
  active_.clear();
  // sites are sorted by z
  const auto place = [&](std::int64_t z) {
    const auto found = std::partition_point(sites_.sites.begin(), sites_.sites.end(),
                                            [&](const Site& site) { return site.z < z; });
    return static_cast<std::size_t>(found - sites_.sites.begin());
  };
  const auto reach = static_cast<std::int64_t>(coverage_.farthest()) + 1;
  limit_by_reach(place(frame_.slice_z(first) - reach), place(frame_.slice_z(last) + reach + 1));
}

// Sites wait for the first slice within reach, and rows beyond it are not theirs.
template <class Arithmetic>
void SlabSweep<Arithmetic>::limit_by_reach(std::size_t from, std::size_t to) {
  const double step = frame_.plane.pixel().y;
  const double step_z = frame_.step_z();
  for (std::size_t s = from; s < to; ++s) {
    const Site& site = sites_.sites[s];
    const double reach = coverage_.reach(site);
    const double row = static_cast<double>(site.y) / step + frame_.plane.middle_row();
    const double slice = static_cast<double>(site.z) / step_z + frame_.middle_slice();
    wedge_[s] = {{row - reach / step, 0.0}, {row + reach / step, 0.0}};
    const double last = std::floor(slice + reach / step_z + row_rounding);
    last_slice_[s] = static_cast<std::int32_t>(std::clamp(last, -1.0, static_cast<double>(last_)));
    const double first = std::ceil(slice - reach / step_z - row_rounding);
    wait_for_slice(static_cast<std::int32_t>(s), std::max<double>(first_, first));
  }
}

template <class Arithmetic>
void SlabSweep<Arithmetic>::next_slice() {
  ++slice_;
  z_ = frame_.slice_z(slice_);
  row_ = 0;
  for (const std::int32_t column : order_) columns_[static_cast<std::size_t>(column)] = {};
  order_.clear();
  is_stale_ = true;
  std::fill(of_row_.begin(), of_row_.end(), none);
  wake_slice();
}

// The sites that may be nearest in this slice: those of the last one, and those that have waited for this one.
template <class Arithmetic>
void SlabSweep<Arithmetic>::wake_slice() {
  std::erase_if(active_, [&](std::int32_t s) { return !is_active_[static_cast<std::size_t>(s)]; });
  for (std::int32_t s = of_slice_[static_cast<std::size_t>(slice_ - first_)]; s != none;
       s = next_[static_cast<std::size_t>(s)]) {
    is_active_[static_cast<std::size_t>(s)] = 1;
    active_.push_back(s);
  }
  for (const std::int32_t s : active_) place_in_slice(s);
}

template <class Arithmetic>
void SlabSweep<Arithmetic>::place_in_slice(std::int32_t site) {
  if (last_slice_[static_cast<std::size_t>(site)] < slice_) {
    wait_for_slice(site, Wedge::infinity);
    return;
  }
  const Wedge& wedge = wedge_[static_cast<std::size_t>(site)];
  const std::int32_t first = wedge.first_row(slice_, rows());
  if (first < rows() && first <= wedge.last_row(slice_, rows())) {
    wait_for_row(site, first);
  } else {
    wait_for_slice(site, wedge.opening(slice_, rows()));
  }
}

template <class Arithmetic>
void SlabSweep<Arithmetic>::wait_for_row(std::int32_t site, double row) {
  if (row >= rows()) return;
  auto& first = of_row_[static_cast<std::size_t>(row)];
  next_[static_cast<std::size_t>(site)] = first;
  first = site;
}

template <class Arithmetic>
void SlabSweep<Arithmetic>::wait_for_slice(std::int32_t site, double slice) {
  is_active_[static_cast<std::size_t>(site)] = 0;
  if (slice > last_) return;
  auto& first = of_slice_[static_cast<std::size_t>(slice) - static_cast<std::size_t>(first_)];
  next_[static_cast<std::size_t>(site)] = first;
  first = site;
}

// Keeps a hidden seed where it may be nearest again.
template <class Arithmetic>
void SlabSweep<Arithmetic>::put_aside(std::int32_t site, const Excess& excess) {
  Wedge& wedge = wedge_[static_cast<std::size_t>(site)];
  const auto [here, a_row, a_slice] = excess;
  if (a_row == 0) {
    wait_for_slice(site, a_slice < 0 ? slice_ + steps_to_zero(here, -a_slice) : Wedge::infinity);
    return;
  }
  const double slope = -a_slice / a_row;
  const Line line{row_ - here / a_row - slope * slice_, slope};
  if (a_row > 0) {
    wedge.upper = line;
    return;
  }
  wedge.lower = line;
  const double row = row_ + steps_to_zero(here, -a_row);
  if (row <= wedge.last_row(slice_, rows())) wait_for_row(site, row);
}

// Puts the sites that have waited for this row into their columns.
template <class Arithmetic>
void SlabSweep<Arithmetic>::insert_waiting() {
  for (std::int32_t s = of_row_[static_cast<std::size_t>(row_)]; s != none;) {
    const std::int32_t following = next_[static_cast<std::size_t>(s)];
    Column& column = columns_[static_cast<std::size_t>(site_of(s).column)];
    if (column.site != none) {
      contest(s, column.site);
    } else {
      if (!column.listed) fresh_.push_back(site_of(s).column);
      settle(site_of(s).column, s);
    }
    is_stale_ = true;
    s = following;
  }
}

template <class Arithmetic>
void SlabSweep<Arithmetic>::settle(std::int32_t column, std::int32_t site) {
  const Site& of = site_of(site);
  columns_[static_cast<std::size_t>(column)] = {of.x, of.y, of.z, of.label, site, true};
}

// Of two sites in one column the nearer one stays; at equal distance the smaller label.
template <class Arithmetic>
void SlabSweep<Arithmetic>::contest(std::int32_t site, std::int32_t other) {
  const Site& a = site_of(site);
  const Column& b = columns_[static_cast<std::size_t>(a.column)];
  const auto square = [&](std::int64_t y, std::int64_t z) {
    return Measure{y - y_} * (y - y_) + Measure{z - z_} * (z - z_);
  };
  const Measure rise = square(a.y, a.z) - square(b.y, b.z);
  const bool wins = rise < 0 || (rise == 0 && a.label < b.label);
  const double sign = wins ? -1 : 1;
  const Excess excess{sign * static_cast<double>(rise),
                      -2 * sign * static_cast<double>(a.y - b.y) * frame_.plane.pixel().y,
                      -2 * sign * static_cast<double>(a.z - b.z) * frame_.step_z()};
  if (wins) settle(a.column, site);
  put_aside(wins ? other : site, excess);
}

template <class Arithmetic>
void SlabSweep<Arithmetic>::rebuild_list() {
  std::sort(fresh_.begin(), fresh_.end());
  merged_.clear();
  auto next = fresh_.begin();
  const auto take = [&](std::int32_t column) {
    Column& state = columns_[static_cast<std::size_t>(column)];
    if (state.site == none) {
      state.listed = false;
      return;
    }
    write_entry(static_cast<std::int32_t>(merged_.size()), column);
    merged_.push_back(column);
  };
  for (const std::int32_t column : order_) {
    for (; next != fresh_.end() && *next < column; ++next) take(*next);
    take(column);
  }
  for (; next != fresh_.end(); ++next) take(*next);
  order_.swap(merged_);
  fresh_.clear();
  list_.count = static_cast<std::int32_t>(order_.size());
  is_stale_ = false;
}

template <class Arithmetic>
void SlabSweep<Arithmetic>::write_entry(std::int32_t entry, std::int32_t column) {
  const Column& site = columns_[static_cast<std::size_t>(column)];
  const auto x = static_cast<Value>(site.x);
  const auto dz = static_cast<Value>(site.z - z_);
  list_.x[entry] = x;
  list_.base[entry] = x * x + dz * dz;
  list_.y[entry] = static_cast<Coordinate>(site.y);
  labels_[entry] = site.label;
}

template <class Arithmetic>
template <class Integer>
auto SlabSweep<Arithmetic>::excess_between(const Column& i, const Column& a, const Column& b) const
    -> Excess {
  const auto f = [&](const Column& s) {
    return Integer{s.x} * s.x + Integer{s.y - y_} * (s.y - y_) + Integer{s.z - z_} * (s.z - z_);
  };
  const Integer before = i.x - a.x;
  const Integer after = b.x - i.x;
  const Integer at = f(i);
  return {static_cast<double>((at - f(a)) * after + (at - f(b)) * before),
          -2 * static_cast<double>((i.y - a.y) * after + (i.y - b.y) * before) * frame_.plane.pixel().y,
          -2 * static_cast<double>((i.z - a.z) * after + (i.z - b.z) * before) * frame_.step_z()};
}

template <class Arithmetic>
void SlabSweep<Arithmetic>::file_dead() {
  const auto column_of = [&](std::uint32_t entry) -> Column& {
    return columns_[static_cast<std::size_t>(order_[entry])];
  };
  for (std::int32_t k = 0; k < envelope_.dead_count; ++k) {
    const Column& dead = column_of(envelope_.dead[k]);
    const Column& left = column_of(envelope_.dead_left[k]);
    const Column& right = column_of(envelope_.dead_right[k]);
    put_aside(dead.site, pixels_.products_exact ? excess_between<std::int64_t>(dead, left, right)
                                                : excess_between<numbers::int128>(dead, left, right));
  }
  for (std::int32_t k = 0; k < envelope_.dead_count; ++k) column_of(envelope_.dead[k]).site = none;
  is_stale_ = is_stale_ || envelope_.dead_count > 0;
}

template <class Arithmetic>
auto SlabSweep<Arithmetic>::next_row() -> const Envelope& {
  y_ = frame_.plane.row_y(row_);
  insert_waiting();
  if (is_stale_) rebuild_list();
  kernel_.list(list_, static_cast<Coordinate>(y_), pixels_, envelope_);
  file_dead();
  kernel_.bound(pixels_, envelope_);
  ++row_;
  return envelope_;
}

template class SlabSweep<tessellation::Narrow>;
template class SlabSweep<tessellation::Wide>;

}  // namespace vorotool::core::volumes
