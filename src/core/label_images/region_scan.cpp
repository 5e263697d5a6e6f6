#include "core/label_images/region_scan.hpp"

#include <algorithm>
#include <stdexcept>

namespace vorotool::core::label_images {

std::uint32_t ComponentSets::add() {
  if (parent_.size() >= no_component) throw std::length_error("the image has more than 2^32 - 2 components");
  parent_.push_back(size());
  return size() - 1;
}

std::uint32_t ComponentSets::find(std::uint32_t component) {
  while (parent_[component] != component) {
    parent_[component] = parent_[parent_[component]];  // path halving
    component = parent_[component];
  }
  return component;
}

bool ComponentSets::unite(std::uint32_t one, std::uint32_t other) {
  one = find(one);
  other = find(other);
  if (one == other) return false;
  parent_[std::max(one, other)] = std::min(one, other);
  return true;
}

void ComponentSets::append(const ComponentSets& other) {
  const std::uint32_t offset = size();
  if (std::uint64_t{offset} + other.size() >= no_component) {
    throw std::length_error("the image has more than 2^32 - 2 components");
  }
  for (const std::uint32_t parent : other.parent_) parent_.push_back(parent + offset);
}

std::uint32_t ComponentSets::settle(std::span<std::uint32_t> number) {
  number[0] = 0;
  std::uint32_t count = 0;
  for (std::uint32_t k = 0; k < size(); ++k) {
    const std::uint32_t smallest = find(k);
    number[k + 1] = smallest == k ? ++count : number[smallest + 1];
  }
  return count;
}

void find_overlaps(const RunRow& above, const RunRow& below, std::vector<Overlap>& overlaps) {
  const std::size_t count = above.size() - 1;
  overlaps.resize(count + below.size() - 1);  // each overlap ends a run of one row or of both
  std::size_t found = 0;
  std::uint32_t x = 0;
  for (std::uint32_t i = 0, j = 0; i < count;) {
    const std::uint32_t above_end = above[i + 1].start;
    const std::uint32_t below_end = below[j + 1].start;
    const std::uint32_t end = std::min(above_end, below_end);
    overlaps[found++] = {i, j, end - x};
    x = end;
    i += above_end == end;
    j += below_end == end;
  }
  overlaps.resize(found);
}

BandScan::BandScan(std::size_t width, std::size_t first_row)
    : labels{0}, regions(1), starts_(width), y_(static_cast<std::uint32_t>(first_row)) {}

template <class Label>
void BandScan::add_row(std::span<const Label> row) {
  cut(row);
  overlaps_.clear();
  if (!last_runs.empty()) find_overlaps(last_runs, runs_, overlaps_);
  for (const Overlap& overlap : overlaps_) {
    if (last_runs[overlap.above].label == runs_[overlap.below].label) {
      join(last_runs[overlap.above], runs_[overlap.below], overlap.length);
    }
  }
  open_components();
  count_borders();
  measure();
  if (first_runs.empty()) first_runs = runs_;
  last_runs.swap(runs_);
  ++y_;
}

template <class Label>
void BandScan::cut(std::span<const Label> row) {
  const std::size_t count = starts_.cut(row);
  runs_.resize(count + 1);
  for (std::size_t k = 0; k < count; ++k) runs_[k] = {starts_[k], row[starts_[k]], 0, no_component};
  runs_[count] = {starts_[count], 0, 0, no_component};
}

// The same label on both sides of `length` pixel sides: these are no boundary, and connect the two runs.
void BandScan::join(const Run& above, Run& below, std::uint32_t length) {
  if (above.label == 0) return;
  Region& region = regions[above.region];
  region.perimeter -= 2 * std::int64_t{length};
  if (below.component == no_component) {
    below.region = above.region;
    below.component = components.find(above.component);
  } else if (components.unite(below.component, above.component)) {
    --region.components;
  }
}

// A run that continues nothing of the row above starts a component; only here is a label looked up.
void BandScan::open_components() {
  for (std::size_t k = 0; k + 1 < runs_.size(); ++k) {
    Run& run = runs_[k];
    if (run.label == 0 || run.component != no_component) continue;
    std::uint64_t& number = numbers_[run.label];
    if (number == 0) {
      number = labels.size();
      labels.push_back(run.label);
      regions.emplace_back();
    }
    run.region = static_cast<std::uint32_t>(number);
    run.component = components.add();
    ++regions[run.region].components;
  }
}

void BandScan::count_borders() {
  for (const Overlap& overlap : overlaps_) {
    const std::uint32_t a = last_runs[overlap.above].region;
    const std::uint32_t b = runs_[overlap.below].region;
    if (a != b && a != 0 && b != 0) borders[border_key(a, b)] += overlap.length;
  }
  for (std::size_t k = 1; k + 1 < runs_.size(); ++k) {
    const std::uint32_t a = runs_[k - 1].region;
    const std::uint32_t b = runs_[k].region;
    if (a != 0 && b != 0) borders[border_key(a, b)] += vertical_side;
  }
}

// Every run counts all its sides as boundary; join() takes back those inside the region.
void BandScan::measure() {
  for (std::size_t k = 0; k + 1 < runs_.size(); ++k) {
    if (runs_[k].label == 0) continue;
    const std::int64_t start = runs_[k].start;
    const std::int64_t end = runs_[k + 1].start;
    const std::int64_t length = end - start;
    Region& region = regions[runs_[k].region];
    region.area += length;
    region.perimeter += 2 * length + 2;
    region.vertical += 2;
    region.sum_x += (start + end - 1) * length / 2;  // one of the factors is even
    region.sum_y += y_ * length;
    region.left = std::min(region.left, runs_[k].start);
    region.right = std::max(region.right, runs_[k + 1].start - 1);
    region.top = std::min(region.top, y_);
    region.bottom = y_;
  }
}

template void BandScan::add_row(std::span<const std::uint8_t>);
template void BandScan::add_row(std::span<const std::uint16_t>);
template void BandScan::add_row(std::span<const std::uint32_t>);

}  // namespace vorotool::core::label_images
