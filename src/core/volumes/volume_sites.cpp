#include "core/volumes/volume_sites.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/base/radix_sort.hpp"

namespace vorotool::core::volumes {

namespace {

// A coordinate on the lattice, seen from the middle of the frame.
std::int64_t relative(std::int64_t coordinate, std::int64_t middle, std::int32_t unit, std::size_t index) {
  std::int64_t difference = 0;
  if (__builtin_sub_overflow(coordinate, middle, &difference) ||
      __builtin_mul_overflow(difference, std::int64_t{unit}, &difference) || difference > wide_bound ||
      difference < -wide_bound) {
    throw tessellation::SeedTooFar(index, wide_bound);
  }
  return difference;
}

bool is_before(const Site& a, const Site& b) {
  return std::tie(a.z, a.y, a.x, a.label) < std::tie(b.z, b.y, b.x, b.label);
}

// The values along an axis, from the least one on.
struct Extent {
  std::int64_t low = std::numeric_limits<std::int64_t>::max();
  std::int64_t high = std::numeric_limits<std::int64_t>::min();

  void add(std::int64_t value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  int bits() const { return std::bit_width(static_cast<std::uint64_t>(high - low)); }
  std::int64_t largest() const { return std::max(std::abs(low), std::abs(high)); }
};

// The numbers of the sites by increasing place, which one word holds.
std::vector<std::uint32_t> sorted_numbers(const std::vector<Site>& sites,
                                          const std::array<Extent, 3>& extents) {
  const auto& [along_x, along_y, along_z] = extents;
  const auto place_of = [&](const Site& site) {
    const auto x = static_cast<std::uint64_t>(site.x - along_x.low);
    const auto y = static_cast<std::uint64_t>(site.y - along_y.low);
    const auto z = static_cast<std::uint64_t>(site.z - along_z.low);
    return (z << along_y.bits() | y) << along_x.bits() | x;
  };
  const int bits = along_x.bits() + along_y.bits() + along_z.bits();
  const int number_bits = std::bit_width(sites.size());
  std::vector<std::uint32_t> numbers(sites.size());
  if (bits + number_bits <= 64) {
    std::vector<std::uint64_t> words(sites.size());
    for (std::size_t s = 0; s < sites.size(); ++s) words[s] = place_of(sites[s]) << number_bits | s;
    base::radix_sort(words, number_bits, number_bits + bits);
    const std::uint64_t mask = (std::uint64_t{1} << number_bits) - 1;
    for (std::size_t s = 0; s < sites.size(); ++s) numbers[s] = static_cast<std::uint32_t>(words[s] & mask);
    return numbers;
  }
  std::vector<base::Keyed> items(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s)
    items[s] = {place_of(sites[s]), static_cast<std::uint32_t>(s)};
  base::radix_sort(items, bits);
  for (std::size_t s = 0; s < sites.size(); ++s) numbers[s] = items[s].value;
  return numbers;
}

// Sorts by (z, y, x); where no word holds a place by the label too.
void sort_by_place(std::vector<Site>& sites, const std::array<Extent, 3>& extents) {
  if (extents[0].bits() + extents[1].bits() + extents[2].bits() > 63) {
    std::sort(sites.begin(), sites.end(), is_before);
    return;
  }
  const std::vector<std::uint32_t> numbers = sorted_numbers(sites, extents);
  std::vector<Site> sorted(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) sorted[s] = sites[numbers[s]];
  sites.swap(sorted);
}

// Of the sites at one place, which follow each other, the one with the smallest label stays.
void drop_duplicates(std::vector<Site>& sites) {
  std::size_t kept = 0;
  for (std::size_t s = 0; s < sites.size(); ++s) {
    Site& last = sites[kept == 0 ? 0 : kept - 1];
    if (kept > 0 && last.x == sites[s].x && last.y == sites[s].y && last.z == sites[s].z) {
      last.label = std::min(last.label, sites[s].label);
    } else {
      sites[kept++] = sites[s];
    }
  }
  sites.resize(kept);
}

// Numbers the distinct x in increasing order by counting along the extent; gives how many there are.
std::int32_t count_columns(std::vector<Site>& sites, const Extent& along_x) {
  std::vector<std::int32_t> column(static_cast<std::size_t>(along_x.high - along_x.low) + 1, 0);
  const auto of = [&](const Site& site) -> std::int32_t& {
    return column[static_cast<std::size_t>(site.x - along_x.low)];
  };
  for (const Site& site : sites) of(site) = 1;
  std::int32_t columns = 0;
  for (std::int32_t& is_one : column) columns += std::exchange(is_one, columns);
  for (Site& site : sites) site.column = of(site);
  return columns;
}

// The same by sorting, where the extent is long.
std::int32_t sort_columns(std::vector<Site>& sites, const Extent& along_x) {
  std::vector<base::Keyed> items(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) {
    items[s] = {static_cast<std::uint64_t>(sites[s].x - along_x.low), static_cast<std::uint32_t>(s)};
  }
  base::radix_sort(items, along_x.bits());
  std::int32_t column = 0;
  for (std::size_t k = 0; k < items.size(); ++k) {
    column += k > 0 && items[k].key != items[k - 1].key;
    sites[items[k].value].column = column;
  }
  return column + 1;
}

std::int32_t number_columns(std::vector<Site>& sites, const Extent& along_x) {
  if (sites.empty()) return 0;
  constexpr std::int64_t short_extent = std::int64_t{1} << 16;
  const auto count = static_cast<std::int64_t>(sites.size());
  const bool is_short = along_x.high - along_x.low <= std::max(short_extent, 2 * count);
  return is_short ? count_columns(sites, along_x) : sort_columns(sites, along_x);
}

}  // namespace

VolumeSites prepare_sites(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
                          std::span<const std::int64_t> z, std::span<const std::uint32_t> label,
                          const VolumeFrame& frame) {
  if (x.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw std::length_error("more than 2147483647 seeds");
  }
  const auto& plane = frame.plane;
  const std::int64_t middle_x = plane.scale * (plane.x + plane.middle_column());
  const std::int64_t middle_y = plane.scale * (plane.y + plane.middle_row());
  const std::int64_t middle_z = plane.scale * (frame.z + frame.middle_slice());
  VolumeSites made{};
  made.largest_coordinate = std::max({std::int64_t{plane.pixel().x} * (plane.middle_column() + 1),
                                      std::int64_t{plane.pixel().y} * (plane.middle_row() + 1),
                                      std::int64_t{frame.step_z()} * (frame.middle_slice() + 1)});
  auto& sites = made.sites;
  sites.resize(x.size());
  std::array<Extent, 3> extents;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sites[i] = {relative(x[i], middle_x, plane.unit.x, i), relative(y[i], middle_y, plane.unit.y, i),
                relative(z[i], middle_z, frame.unit_z, i), label[i], 0};
    extents[0].add(sites[i].x);
    extents[1].add(sites[i].y);
    extents[2].add(sites[i].z);
  }
  if (sites.empty()) return made;
  for (const Extent& extent : extents) {
    made.largest_coordinate = std::max(made.largest_coordinate, extent.largest());
  }
  sort_by_place(sites, extents);
  drop_duplicates(sites);
  made.duplicates = x.size() - sites.size();
  made.columns = number_columns(sites, extents[0]);
  return made;
}

}  // namespace vorotool::core::volumes
