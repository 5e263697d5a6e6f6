// The pass over a band of rows behind measure_regions; bands are scanned apart and joined along their seams.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/flat_map.hpp"
#include "core/label_images/label_runs.hpp"
#include "core/label_images/region_measures.hpp"

namespace vorotool::core::label_images {

// Disjoint sets of provisional components; the smallest number of a set stands for it.
class ComponentSets {
 public:
  std::uint32_t add();  // throws std::length_error beyond 2^32 - 2
  std::uint32_t find(std::uint32_t component);
  bool unite(std::uint32_t one, std::uint32_t other);  // whether they were apart
  void append(const ComponentSets& other);             // its components follow ours
  // Numbers the sets from 1 in the order of their smallest components: component k gets number[k + 1], and number[0] is
  // 0. `number` has size() + 1 elements. Returns how many sets there are.
  std::uint32_t settle(std::span<std::uint32_t> number);
  std::uint32_t size() const { return static_cast<std::uint32_t>(parent_.size()); }

 private:
  std::vector<std::uint32_t> parent_;  // parent_[i] <= i, equal for a root
};

// A maximal stretch of one label in a row.
struct Run {
  std::uint32_t start;
  std::uint32_t label;
  std::uint32_t region;     // number of the label among those of the band, 0 for the background
  std::uint32_t component;  // no_component until it is known, and for the background
};

constexpr std::uint32_t no_component = UINT32_MAX;

// The runs of a row from left to right, and an end mark that starts at the width.
using RunRow = std::vector<Run>;

// A pair of runs of two neighboring rows with `length` columns in common.
struct Overlap {
  std::uint32_t above;
  std::uint32_t below;
  std::uint32_t length;
};

// All overlaps of two rows of one width from left to right: one merge without unpredictable branches.
void find_overlaps(const RunRow& above, const RunRow& below, std::vector<Overlap>& overlaps);

// Key of an unordered pair of different, nonzero region numbers.
constexpr std::uint64_t border_key(std::uint32_t a, std::uint32_t b) {
  return a < b ? (std::uint64_t{a} << 32 | b) : (std::uint64_t{b} << 32 | a);
}

// Pixel sides that two regions share in a band, in one number: vertical ones in the upper half. Neither half
// overflows: a band of several rows has 2^19 pixels at most, and one row has no horizontal sides within.
constexpr std::uint64_t vertical_side = std::uint64_t{1} << 32;
constexpr std::int64_t vertical_sides(std::uint64_t sides) { return static_cast<std::int64_t>(sides >> 32); }
constexpr std::int64_t horizontal_sides(std::uint64_t sides) {
  return static_cast<std::int64_t>(sides & UINT32_MAX);
}

// Regions of consecutive rows. Region numbers are local: 1, 2, ... in order of appearance, labels[0] = 0.
class BandScan {
 public:
  BandScan(std::size_t width, std::size_t first_row);

  // Rows are given from the top without gap.
  template <class Label>
  void add_row(std::span<const Label> row);

  std::vector<std::uint32_t> labels;
  std::vector<Region> regions;
  base::FlatMap borders;  // border_key -> pixel sides, horizontal and vertical ones
  ComponentSets components;
  RunRow first_runs;
  RunRow last_runs;

 private:
  template <class Label>
  void cut(std::span<const Label> row);
  void join(const Run& above, Run& below, std::uint32_t length);
  void open_components();
  void count_borders();
  void measure();

  RunStarts starts_;
  RunRow runs_;  // of the row at hand; last_runs is the row above
  std::vector<Overlap> overlaps_;
  base::FlatMap numbers_;  // label -> region number
  std::uint32_t y_;
};

}  // namespace vorotool::core::label_images
