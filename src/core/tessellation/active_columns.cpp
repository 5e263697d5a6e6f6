#include "core/tessellation/active_columns.hpp"

#include <algorithm>

namespace vorotool::core::tessellation {

namespace {

// Bits set in a word, in parallel: the baseline instruction set has no instruction for it, and a call costs
// more.
std::int32_t count_bits(std::uint64_t w) {
  w -= w >> 1 & 0x5555555555555555U;
  w = (w & 0x3333333333333333U) + (w >> 2 & 0x3333333333333333U);
  w = (w + (w >> 4)) & 0x0f0f0f0f0f0f0f0fU;
  return static_cast<std::int32_t>(w * 0x0101010101010101U >> 56);
}

}  // namespace

template <class Arithmetic>
ActiveColumns<Arithmetic>::ActiveColumns(const Sites& sites) : sites_(sites) {
  const std::size_t columns = sites.column_x.size();
  const std::size_t padded = columns + kernel_padding;
  x_ = std::make_unique_for_overwrite<Value[]>(padded);
  y_ = std::make_unique_for_overwrite<Coordinate[]>(2 * padded);
  labels_ = std::make_unique_for_overwrite<std::uint32_t[]>(3 * padded);
  column_ = std::make_unique_for_overwrite<std::int32_t[]>(padded);
  below_site_ = std::make_unique_for_overwrite<std::int32_t[]>(padded);
  columns_ = {0,
              x_.get(),
              y_.get(),
              y_.get() + padded,
              labels_.get(),
              labels_.get() + padded,
              labels_.get() + 2 * padded};
  listed_.assign((columns + 63) / 64, 0);
  listed_before_.assign(listed_.size(), 0);
}

template <class Arithmetic>
void ActiveColumns<Arithmetic>::clear() {
  columns_.count = 0;
  waiting_.clear();
  std::fill(listed_.begin(), listed_.end(), 0);
  std::fill(listed_before_.begin(), listed_before_.end(), 0);
}

template <class Arithmetic>
std::size_t ActiveColumns<Arithmetic>::entry_of(std::int32_t c) const {
  const auto word = static_cast<std::size_t>(c) / 64;
  const std::uint64_t before = listed_[word] & ((std::uint64_t{1} << (c % 64)) - 1);
  return static_cast<std::size_t>(listed_before_[word] + count_bits(before));
}

template <class Arithmetic>
void ActiveColumns<Arithmetic>::put(std::int32_t column, std::int32_t above, std::int32_t below) {
  const Change change{column, above, below};
  if (is_listed(column)) {
    apply(entry_of(column), change);
  } else {
    waiting_.push_back(change);
  }
}

template <class Arithmetic>
void ActiveColumns<Arithmetic>::link_below(std::vector<std::int32_t>* follows, std::int32_t offset) {
  follows_ = follows;
  offset_ = offset;
}

template <class Arithmetic>
void ActiveColumns<Arithmetic>::apply(std::size_t entry, const Change& change) {
  if (change.above >= 0) {
    const auto site = static_cast<std::size_t>(change.above);
    columns_.above_y[entry] = static_cast<Coordinate>(sites_.y[site]);
    columns_.above_label[entry] = sites_.label[site];
  }
  if (change.below >= 0) {
    const auto site = static_cast<std::size_t>(change.below);
    if (follows_ != nullptr && columns_.below_y[entry] != Arithmetic::far) {
      (*follows_)[static_cast<std::size_t>(change.below - offset_)] = below_site_[entry];
    }
    columns_.below_y[entry] = static_cast<Coordinate>(sites_.y[site]);
    columns_.below_label[entry] = sites_.label[site];
    below_site_[entry] = change.below;
  } else if (change.below == gone) {
    columns_.below_y[entry] = Arithmetic::far;
  }
}

// Gives the waiting columns entries without a seed, then makes the changes in their order.
template <class Arithmetic>
void ActiveColumns<Arithmetic>::insert() {
  if (waiting_.empty()) return;
  const auto by_column = [](const Change& a, const Change& b) { return a.column < b.column; };
  if (!std::is_sorted(waiting_.begin(), waiting_.end(), by_column)) {
    std::stable_sort(waiting_.begin(), waiting_.end(), by_column);
  }
  std::vector<std::int32_t> fresh;
  for (const Change& change : waiting_) {
    if (fresh.empty() || fresh.back() != change.column) fresh.push_back(change.column);
  }
  make_room(fresh);
  for (const Change& change : waiting_) apply(entry_of(change.column), change);
  waiting_.clear();
}

// Moves the entries apart, from the last on, so that each is moved once.
template <class Arithmetic>
void ActiveColumns<Arithmetic>::make_room(const std::vector<std::int32_t>& fresh) {
  auto end = static_cast<std::size_t>(columns_.count);
  for (std::size_t k = fresh.size(); k-- > 0;) {
    const std::size_t begin = entry_of(fresh[k]);
    move_back(begin, end, k + 1);
    const std::size_t entry = begin + k;
    columns_.x[entry] = static_cast<Value>(sites_.column_x[static_cast<std::size_t>(fresh[k])]);
    columns_.above_y[entry] = -Arithmetic::far;
    columns_.below_y[entry] = Arithmetic::far;
    column_[entry] = fresh[k];
    end = begin;
  }
  columns_.count += static_cast<std::int32_t>(fresh.size());
  std::size_t before = 0;  // fresh columns in the words before
  for (std::size_t word = static_cast<std::size_t>(fresh[0]) / 64; word < listed_.size(); ++word) {
    listed_before_[word] += static_cast<std::int32_t>(before);
    for (; before < fresh.size() && static_cast<std::size_t>(fresh[before]) / 64 == word; ++before) {
      listed_[word] |= std::uint64_t{1} << (fresh[before] % 64);
    }
  }
}

// Moves entries begin ... end - 1 back by some places: array by array where they are many, else one by one.
template <class Arithmetic>
void ActiveColumns<Arithmetic>::move_back(std::size_t begin, std::size_t end, std::size_t places) {
  constexpr std::size_t many = 64;
  if (end - begin < many) {
    while (end > begin) {
      --end;
      move_entry(end, end + places);
    }
    return;
  }
  const auto move = [&](auto* array) {
    std::move_backward(array + begin, array + end, array + end + places);
  };
  move(columns_.x);
  move(columns_.above_y);
  move(columns_.below_y);
  move(columns_.above_label);
  move(columns_.below_label);
  move(column_.get());
  move(below_site_.get());
}

template <class Arithmetic>
void ActiveColumns<Arithmetic>::move_entry(std::size_t from, std::size_t to) {
  columns_.x[to] = columns_.x[from];
  columns_.above_y[to] = columns_.above_y[from];
  columns_.below_y[to] = columns_.below_y[from];
  columns_.above_label[to] = columns_.above_label[from];
  columns_.below_label[to] = columns_.below_label[from];
  column_[to] = column_[from];
  below_site_[to] = below_site_[from];
}

template <class Arithmetic>
void ActiveColumns<Arithmetic>::count_listed() {
  std::int32_t before = 0;
  for (std::size_t word = 0; word < listed_.size(); ++word) {
    listed_before_[word] = before;
    before += count_bits(listed_[word]);
  }
}

template <class Arithmetic>
void ActiveColumns<Arithmetic>::compact() {
  std::size_t kept = 0;
  for (std::size_t e = 0; e < static_cast<std::size_t>(columns_.count); ++e) {
    if (columns_.above_y[e] == -Arithmetic::far && columns_.below_y[e] == Arithmetic::far) {
      listed_[static_cast<std::size_t>(column_[e]) / 64] &= ~(std::uint64_t{1} << (column_[e] % 64));
      continue;
    }
    move_entry(e, kept);
    ++kept;
  }
  columns_.count = static_cast<std::int32_t>(kept);
  count_listed();
}

template class ActiveColumns<Narrow>;
template class ActiveColumns<Filtered>;

}  // namespace vorotool::core::tessellation
