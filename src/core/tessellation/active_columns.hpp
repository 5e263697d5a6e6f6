// The live columns of a sweep as a sorted list, whose entries are found from their columns in constant time.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/tessellation/row_kernel.hpp"
#include "core/tessellation/sorted_seeds.hpp"

namespace vorotool::core::tessellation {

template <class Arithmetic>
class ActiveColumns {
 public:
  // How a row changes the seed of a column: a site replaces it, it goes, or it stays.
  static constexpr std::int32_t gone = -1;
  static constexpr std::int32_t stays = -2;

  explicit ActiveColumns(const Sites& sites);

  const ActiveColumnArrays<Arithmetic>& columns() const { return columns_; }

  void clear();
  // Changes a column. Columns that are not in the list wait for `insert`. Where `follows` is given and a site
  // below takes the place of another one, follows[new - offset] becomes that one.
  void put(std::int32_t column, std::int32_t above, std::int32_t below);
  void link_below(std::vector<std::int32_t>* follows, std::int32_t offset);
  void insert();
  // Takes out the entries without a seed.
  void compact();

  std::int32_t below_site(std::uint32_t entry) const { return below_site_[entry]; }
  void drop_above(std::uint32_t entry) { columns_.above_y[entry] = -Arithmetic::far; }
  void drop_below(std::uint32_t entry) { columns_.below_y[entry] = Arithmetic::far; }

 private:
  using Coordinate = typename Arithmetic::Coordinate;
  using Value = typename Arithmetic::Value;

  struct Change {
    std::int32_t column, above, below;
  };

  bool is_listed(std::int32_t c) const { return listed_[static_cast<std::size_t>(c) / 64] >> (c % 64) & 1; }
  // The entry of a listed column: the number of listed columns before it.
  std::size_t entry_of(std::int32_t c) const;
  void apply(std::size_t entry, const Change& change);
  void make_room(const std::vector<std::int32_t>& fresh);
  void move_back(std::size_t begin, std::size_t end, std::size_t places);
  void move_entry(std::size_t from, std::size_t to);
  void count_listed();

  const Sites& sites_;
  std::unique_ptr<Value[]> x_;
  std::unique_ptr<Coordinate[]> y_;          // above and below
  std::unique_ptr<std::uint32_t[]> labels_;  // above, below and nearer
  std::unique_ptr<std::int32_t[]> column_;   // [count] column of an entry
  std::unique_ptr<std::int32_t[]> below_site_;
  ActiveColumnArrays<Arithmetic> columns_;

  std::vector<std::uint64_t> listed_;        // bit c % 64 of word c / 64: column c has an entry
  std::vector<std::int32_t> listed_before_;  // [words] listed columns before each word
  std::vector<Change> waiting_;              // changes of columns that have no entry yet
  std::vector<std::int32_t>* follows_ = nullptr;
  std::int32_t offset_ = 0;
};

extern template class ActiveColumns<Narrow>;
extern template class ActiveColumns<Filtered>;

}  // namespace vorotool::core::tessellation
