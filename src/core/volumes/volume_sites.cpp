#include "core/volumes/volume_sites.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <tuple>

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

// Numbers the distinct x in increasing order; gives how many there are.
std::int32_t number_columns(std::vector<Site>& sites) {
  std::vector<std::int64_t> x(sites.size());
  std::transform(sites.begin(), sites.end(), x.begin(), [](const Site& site) { return site.x; });
  std::sort(x.begin(), x.end());
  x.erase(std::unique(x.begin(), x.end()), x.end());
  for (Site& site : sites) {
    site.column = static_cast<std::int32_t>(std::lower_bound(x.begin(), x.end(), site.x) - x.begin());
  }
  return static_cast<std::int32_t>(x.size());
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
  std::sort(sites.begin(), sites.end(), [](const Site& a, const Site& b) {
    return std::tie(a.z, a.y, a.x, a.label) < std::tie(b.z, b.y, b.x, b.label);
  });
  const auto same_place = [](const Site& a, const Site& b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
  sites.erase(std::unique(sites.begin(), sites.end(), same_place), sites.end());
  made.duplicates = x.size() - sites.size();
  made.columns = number_columns(sites);
  return made;
}

}  // namespace vorotool::core::volumes
