#include "core/volumes/slab_sweep.hpp"

#include <algorithm>

namespace vorotool::core::volumes {

using numbers::int128;
using tessellation::kernel_padding;
using tessellation::PixelRow;
using tessellation::RowKernel;

template <class Arithmetic>
SlabSweep<Arithmetic>::SlabSweep(const VolumeSites& sites, const VolumeFrame& frame,
                                 const RowKernel<Arithmetic>& kernel)
    : sites_(sites),
      frame_(frame),
      kernel_(kernel),
      pixels_{frame.plane.width, frame.plane.middle_column(), frame.plane.pixel().x,
              sites.largest_coordinate <= exact_product_bound},
      wedge_(sites.sites.size()),
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
  std::fill(wedge_.begin(), wedge_.end(), Wedge{});
  std::fill(is_active_.begin(), is_active_.end(), std::uint8_t{1});
  of_slice_.assign(static_cast<std::size_t>(last - first) + 1, none);
  active_.resize(sites_.sites.size());
  for (std::size_t s = 0; s < active_.size(); ++s) active_[s] = static_cast<std::int32_t>(s);
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
  const auto here = static_cast<double>(excess.here);
  const auto a_row = static_cast<double>(excess.a_row);
  const auto a_slice = static_cast<double>(excess.a_slice);
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
      column.site = s;
      if (!column.listed) fresh_.push_back(site_of(s).column);
      column.listed = true;
    }
    is_stale_ = true;
    s = following;
  }
}

// Of two sites in one column the nearer one stays; at equal distance the smaller label.
template <class Arithmetic>
void SlabSweep<Arithmetic>::contest(std::int32_t site, std::int32_t other) {
  const Site& a = site_of(site);
  const Site& b = site_of(other);
  const auto square = [&](const Site& s) {
    return int128{s.y - y_} * (s.y - y_) + int128{s.z - z_} * (s.z - z_);
  };
  const int128 rise = square(a) - square(b);
  const bool wins = rise < 0 || (rise == 0 && a.label < b.label);
  const int128 sign = wins ? -2 : 2;
  const Excess excess{wins ? -rise : rise, -sign * (a.y - b.y) * frame_.plane.pixel().y,
                      -sign * (a.z - b.z) * frame_.step_z()};
  columns_[static_cast<std::size_t>(a.column)].site = wins ? site : other;
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
  const Site& site = site_of(columns_[static_cast<std::size_t>(column)].site);
  const auto x = static_cast<Value>(site.x);
  const auto dz = static_cast<Value>(site.z - z_);
  list_.x[entry] = x;
  list_.base[entry] = x * x + dz * dz;
  list_.y[entry] = static_cast<Coordinate>(site.y);
  labels_[entry] = site.label;
}

template <class Arithmetic>
auto SlabSweep<Arithmetic>::excess_between(std::int32_t site, std::int32_t left, std::int32_t right) const
    -> Excess {
  const Site& i = site_of(site);
  const Site& a = site_of(left);
  const Site& b = site_of(right);
  const auto f = [&](const Site& s) {
    return int128{s.x} * s.x + int128{s.y - y_} * (s.y - y_) + int128{s.z - z_} * (s.z - z_);
  };
  const int128 before = i.x - a.x;
  const int128 after = b.x - i.x;
  const int128 at = f(i);
  return {(at - f(a)) * after + (at - f(b)) * before,
          -2 * ((i.y - a.y) * after + (i.y - b.y) * before) * frame_.plane.pixel().y,
          -2 * ((i.z - a.z) * after + (i.z - b.z) * before) * frame_.step_z()};
}

template <class Arithmetic>
void SlabSweep<Arithmetic>::file_dead() {
  const auto column_of = [&](std::uint32_t entry) -> Column& {
    return columns_[static_cast<std::size_t>(order_[entry])];
  };
  for (std::int32_t k = 0; k < envelope_.dead_count; ++k) {
    const std::int32_t site = column_of(envelope_.dead[k]).site;
    put_aside(site, excess_between(site, column_of(envelope_.dead_left[k]).site,
                                   column_of(envelope_.dead_right[k]).site));
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
