#include "core/volumes/volume_sites.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <stdexcept>
#include <tuple>

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

std::int64_t largest(const Site& site) {
  return std::max({std::abs(site.x), std::abs(site.y), std::abs(site.z)});
}

bool is_before(const Site& a, const Site& b) {
  return std::tie(a.z, a.y, a.x, a.label) < std::tie(b.z, b.y, b.x, b.label);
}

// Sorts by (z, y, x, label); where one word holds a place the word is sorted.
void sort_by_place(std::vector<Site>& sites) {
  std::array<std::int64_t, 3> least{}, bits{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    constexpr std::int64_t Site::* along[] = {&Site::x, &Site::y, &Site::z};
    const auto smaller = [&](const Site& a, const Site& b) { return a.*along[axis] < b.*along[axis]; };
    const auto [low, high] = std::minmax_element(sites.begin(), sites.end(), smaller);
    if (low == sites.end()) return;
    least[axis] = *low.*along[axis];
    bits[axis] = std::bit_width(static_cast<std::uint64_t>(*high.*along[axis] - least[axis]));
  }
  if (bits[0] + bits[1] + bits[2] > 63) {
    std::sort(sites.begin(), sites.end(), is_before);
    return;
  }
  std::vector<base::Keyed> items(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) {
    const auto x = static_cast<std::uint64_t>(sites[s].x - least[0]);
    const auto y = static_cast<std::uint64_t>(sites[s].y - least[1]);
    const auto z = static_cast<std::uint64_t>(sites[s].z - least[2]);
    items[s] = {(z << bits[1] | y) << bits[0] | x, static_cast<std::uint32_t>(s)};
  }
  base::radix_sort(items, static_cast<int>(bits[0] + bits[1] + bits[2]));
  std::vector<Site> sorted(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) sorted[s] = sites[items[s].value];
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

// Numbers the distinct x in increasing order; gives how many there are.
std::int32_t number_columns(std::vector<Site>& sites) {
  const auto [low, high] =
      std::minmax_element(sites.begin(), sites.end(), [](const Site& a, const Site& b) { return a.x < b.x; });
  if (low == sites.end()) return 0;
  const std::int64_t least = low->x;
  const int bits = std::bit_width(static_cast<std::uint64_t>(high->x - least));
  std::vector<base::Keyed> items(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) {
    items[s] = {static_cast<std::uint64_t>(sites[s].x - least), static_cast<std::uint32_t>(s)};
  }
  base::radix_sort(items, bits);
  std::int32_t column = 0;
  for (std::size_t k = 0; k < items.size(); ++k) {
    column += k > 0 && items[k].key != items[k - 1].key;
    sites[items[k].value].column = column;
  }
  return column + 1;
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
  for (std::size_t i = 0; i < x.size(); ++i) {
    sites[i] = {relative(x[i], middle_x, plane.unit.x, i), relative(y[i], middle_y, plane.unit.y, i),
                relative(z[i], middle_z, frame.unit_z, i), label[i], 0};
    made.largest_coordinate = std::max(made.largest_coordinate, largest(sites[i]));
  }
  sort_by_place(sites);
  drop_duplicates(sites);
  made.duplicates = x.size() - sites.size();
  made.columns = number_columns(sites);
  return made;
}

}  // namespace vorotool::core::volumes
