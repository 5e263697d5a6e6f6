#include "core/volumes/seed_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/parallel.hpp"

namespace vorotool::core::volumes {

namespace {

// Floats hold differences up to this one, and their doubles.
constexpr std::int64_t largest_difference = std::int64_t{1} << 23;

constexpr double seeds_a_cell = 4.0;
constexpr std::size_t seeds_of_dense = 60;
// Of a row of cells so many seeds are tried for one that is near.
constexpr std::size_t seeds_to_try = 32;

}  // namespace

void SeedList::make_room(std::int64_t more) {
  const auto needed = static_cast<std::size_t>(count + more) + seed_padding;
  if (needed <= x_.size()) return;
  const std::size_t size = needed + needed / 2;
  x_.resize(size);
  y_.resize(size);
  z_.resize(size);
  label_.resize(size);
}

bool SeedGrid::suits(const VolumeSites& sites) {
  if (sites.largest_coordinate > largest_difference / 2) return false;
  // squared distances are at most 12 N^2
  const int square_bits = 2 * std::bit_width(static_cast<std::uint64_t>(sites.largest_coordinate)) + 4;
  return square_bits + std::bit_width(sites.all_labels) < 64;
}

SeedGrid::SeedGrid(const VolumeSites& volume, const VolumeFrame& frame, unsigned threads)
    : x_(volume.sites.size()),
      y_(volume.sites.size()),
      z_(volume.sites.size()),
      label_(volume.sites.size()),
      label_bits_(std::bit_width(volume.all_labels)) {
  const std::span<const Site> sites = volume.sites;
  choose_cells(sites.size(), frame);
  first_.resize(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]) + 1);
  first_.back() = static_cast<std::uint32_t>(sites.size());
  // sites are sorted by z, so those of a layer of cells follow each other
  const auto first_of = [&](std::int64_t layer) {
    const auto found = std::partition_point(sites.begin(), sites.end(),
                                            [&](const Site& site) { return cell_along(2, site.z) < layer; });
    return static_cast<std::size_t>(found - sites.begin());
  };
  base::parallel_for(static_cast<std::size_t>(count_[2]), threads, [&](std::size_t number) {
    const auto layer = static_cast<std::int64_t>(number);
    const std::size_t first = first_of(layer);
    fill_layer(layer, sites.subspan(first, first_of(layer + 1) - first), first);
  });
}

void SeedGrid::choose_cells(std::size_t seeds, const VolumeFrame& frame) {
  const auto& plane = frame.plane;
  const Cell voxels{plane.width, plane.height, frame.depth};
  const Cell step{plane.pixel().x, plane.pixel().y, frame.step_z()};
  low_ = {-step[0] * plane.middle_column(), -step[1] * plane.middle_row(), -step[2] * frame.middle_slice()};
  double volume = seeds_a_cell / static_cast<double>(seeds);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    volume *= static_cast<double>(voxels[axis]) * static_cast<double>(step[axis]);
  }
  double side = 1;  // the cube root, by operations that all machines round alike
  for (int step_of_root = 0; step_of_root < 16; ++step_of_root) side = std::sqrt(std::sqrt(volume * side));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto across = static_cast<std::int64_t>(side / static_cast<double>(step[axis]));
    const std::int64_t of_cell = std::clamp<std::int64_t>(across, 1, voxels[axis]);
    side_[axis] = of_cell * step[axis];
    count_[axis] = (voxels[axis] + of_cell - 1) / of_cell;
  }
}

// The sites of a layer, of which the first has a number, by cell and in their order.
void SeedGrid::fill_layer(std::int64_t layer, std::span<const Site> sites, std::size_t number) {
  const auto cells = static_cast<std::size_t>(count_[0] * count_[1]);
  const auto first = std::span(first_).subspan(static_cast<std::size_t>(layer) * cells, cells);
  std::vector<std::uint32_t> cell(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) {
    cell[s] = static_cast<std::uint32_t>(cell_along(1, sites[s].y) * count_[0] + cell_along(0, sites[s].x));
    ++first[cell[s]];
  }
  auto sum = static_cast<std::uint32_t>(number);
  for (std::uint32_t& begin : first) sum += std::exchange(begin, sum);
  // each cell's first seed moves to the next one's, and then back
  for (std::size_t s = 0; s < sites.size(); ++s) {
    const Site& site = sites[s];
    const std::size_t at = first[cell[s]]++;
    x_[at] = static_cast<std::int32_t>(site.x);
    y_[at] = static_cast<std::int32_t>(site.y);
    z_[at] = static_cast<std::int32_t>(site.z);
    label_[at] = site.label;
  }
  std::copy_backward(first.begin(), first.end() - 1, first.end());
  first.front() = static_cast<std::uint32_t>(number);
}

// The cell of a place, or the nearest one to it.
std::int64_t SeedGrid::cell_along(std::size_t axis, std::int64_t place) const {
  if (place < low_[axis]) return 0;
  return std::min((place - low_[axis]) / side_[axis], count_[axis] - 1);
}

// Calls body(first, count) for the seeds of each row of cells.
template <class Body>
void SeedGrid::for_each_run(const Cell& from, const Cell& to, Body body) const {
  for (std::int64_t z = from[2]; z <= to[2]; ++z) {
    for (std::int64_t y = from[1]; y <= to[1]; ++y) {
      const std::int64_t row = (z * count_[1] + y) * count_[0];
      const std::size_t first = first_[static_cast<std::size_t>(row + from[0])];
      const std::size_t end = first_[static_cast<std::size_t>(row + to[0]) + 1];
      if (first < end) body(first, end - first);
    }
  }
}

// The place of a seed that is not much farther from a place than the nearest one, mostly.
std::array<std::int64_t, 3> SeedGrid::place_near(const std::array<std::int64_t, 3>& place) const {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::int64_t around = 1; std::isinf(least); around *= 2) {
    Cell from{}, to{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t cell = cell_along(axis, place[axis]);
      from[axis] = std::max<std::int64_t>(0, cell - around);
      to[axis] = std::min(count_[axis] - 1, cell + around);
    }
    for_each_run(from, to, [&](std::size_t first, std::size_t count) {
      for (std::size_t s = first; s < first + count; s += 1 + count / seeds_to_try) {
        const auto x = static_cast<double>(x_[s] - place[0]);
        const auto y = static_cast<double>(y_[s] - place[1]);
        const auto z = static_cast<double>(z_[s] - place[2]);
        const double square = x * x + y * y + z * z;
        if (square >= least) continue;
        least = square;
        best = s;
      }
    });
  }
  return {x_[best], y_[best], z_[best]};
}

bool SeedGrid::is_dense(const PlaceBox& box) const {
  Cell from{}, to{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    from[axis] = cell_along(axis, box.low[axis]);
    to[axis] = cell_along(axis, box.high[axis]);
  }
  std::size_t seeds = 0;
  for_each_run(from, to, [&](std::size_t, std::size_t count) { seeds += count; });
  return seeds > seeds_of_dense;
}

std::int64_t SeedGrid::gather(const PlaceBox& box, const BrickKernels& kernels, SeedList& list,
                              SeedList& room) const {
  const auto middle = box.middle();
  const auto at = place_near(middle);
  LatticeBox local{};
  Rival rival{};
  double square = 0, widest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    local.low[axis] = static_cast<float>(box.low[axis] - middle[axis]);
    local.high[axis] = static_cast<float>(box.high[axis] - middle[axis]);
    rival.at[axis] = static_cast<float>(at[axis] - middle[axis]);
    const auto farthest = static_cast<double>(
        std::max(std::abs(at[axis] - box.low[axis]), std::abs(at[axis] - box.high[axis])));
    square += farthest * farthest;
    widest = std::max(widest, static_cast<double>(box.high[axis] - middle[axis]) + 1);
  }
  // what is farther than this from the box along an axis is farther than the rival
  const auto reach = static_cast<std::int64_t>(std::sqrt(square)) + 1;
  rival.slack = slack_of(static_cast<double>(reach) + widest);
  Cell from{}, to{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    from[axis] = cell_along(axis, box.low[axis] - reach);
    to[axis] = cell_along(axis, box.high[axis] + reach);
  }
  std::size_t found = 0;
  for_each_run(from, to, [&](std::size_t, std::size_t count) { found += count; });
  room.count = list.count = 0;
  room.make_room(static_cast<std::int64_t>(found));
  list.make_room(static_cast<std::int64_t>(found));
  const SeedArrays all = room.from(0);
  const auto relative = [](const std::int32_t* places, std::int64_t origin, std::size_t count,
                           float* to_floats) {
    const auto shift = static_cast<std::int32_t>(origin);
    for (std::size_t s = 0; s < count; ++s) to_floats[s] = static_cast<float>(places[s] - shift);
  };
  std::size_t copied = 0;
  for_each_run(from, to, [&](std::size_t first, std::size_t count) {
    relative(x_.data() + first, middle[0], count, all.x + copied);
    relative(y_.data() + first, middle[1], count, all.y + copied);
    relative(z_.data() + first, middle[2], count, all.z + copied);
    std::copy_n(label_.data() + first, count, all.label + copied);
    copied += count;
  });
  list.count = kernels.keep(all, static_cast<std::int32_t>(found), local, rival, list.from(0), 0);
  return static_cast<std::int64_t>(found);
}

}  // namespace vorotool::core::volumes
