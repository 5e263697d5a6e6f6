#include "core/volumes/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vorotool::core::volumes {

namespace {

// Seeds in a block of a uniform set, about: fewer would leave many blocks empty, more would make bounds wide.
constexpr double seeds_a_block = 2.0;
// Sides that are tried differ by this factor.
constexpr double growth = 1.0625;
// Blocks that are looked at in each direction for seeds, before the farthest of all has to do.
constexpr std::int64_t most_rings = 4;
// The roundings of a few sums and a root, and of what is compared with it.
constexpr double slack = 1 + 0x1p-40;

double square(double v) { return v * v; }

}  // namespace

Coverage::Coverage(std::span<const Site> sites, const VolumeFrame& frame) {
  const auto& plane = frame.plane;
  const Block voxels{plane.width, plane.height, frame.depth};
  const Block step{plane.pixel().x, plane.pixel().y, frame.step_z()};
  low_ = {-step[0] * plane.middle_column(), -step[1] * plane.middle_row(), -step[2] * frame.middle_slice()};
  double volume = seeds_a_block / static_cast<double>(sites.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    volume *= static_cast<double>(voxels[axis]) * static_cast<double>(step[axis]);
  }
  double side = 1;
  while (side * side * side < volume) side *= growth;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto across = static_cast<std::int64_t>(side / static_cast<double>(step[axis]));
    const std::int64_t of_block = std::clamp<std::int64_t>(across, 1, voxels[axis]);
    side_[axis] = of_block * step[axis];
    count_[axis] = (voxels[axis] + of_block - 1) / of_block;
  }
  bound_blocks(sites);
}

// The block of a site, or the nearest one to it.
std::size_t Coverage::block_of(const Site& site) const {
  const Block at{site.x, site.y, site.z};
  Block block{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    block[axis] = std::clamp<std::int64_t>((at[axis] - low_[axis]) / side_[axis], 0, count_[axis] - 1);
  }
  return number(block);
}

void Coverage::bound_blocks(std::span<const Site> sites) {
  const auto blocks = static_cast<std::size_t>(count_[0] * count_[1] * count_[2]);
  // the sites of each block, as a list
  std::vector<std::size_t> first(blocks + 1, 0);
  std::vector<std::size_t> block(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) ++first[(block[s] = block_of(sites[s])) + 1];
  for (std::size_t b = 0; b < blocks; ++b) first[b + 1] += first[b];
  std::vector<Site> sorted(sites.size());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (std::size_t s = 0; s < sites.size(); ++s) sorted[next[block[s]]++] = sites[s];

  reach_.assign(blocks, -1.0);
  Block at{};
  for (at[2] = 0; at[2] < count_[2]; ++at[2]) {
    for (at[1] = 0; at[1] < count_[1]; ++at[1]) {
      for (at[0] = 0; at[0] < count_[0]; ++at[0]) {
        reach_[number(at)] = bound(sorted, first, at) * slack;
        farthest_ = std::max(farthest_, reach_[number(at)]);
      }
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    spread_along(axis, static_cast<std::int64_t>(farthest_ / static_cast<double>(side_[axis])) + 1);
  }
}

// The least distance to one seed of the farthest place in a block.
double Coverage::bound(std::span<const Site> sorted, std::span<const std::size_t> first,
                       const Block& block) const {
  std::array<double, 3> low{}, high{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = static_cast<double>(low_[axis] + block[axis] * side_[axis]);
    high[axis] = low[axis] + static_cast<double>(side_[axis]);
  }
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const Site& site) {
    const std::array<double, 3> at{static_cast<double>(site.x), static_cast<double>(site.y),
                                   static_cast<double>(site.z)};
    double distance = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      distance += square(std::max(std::fabs(at[axis] - low[axis]), std::fabs(at[axis] - high[axis])));
    }
    least = std::min(least, distance);
  };
  for (std::int64_t ring = 1; ring <= most_rings && std::isinf(least); ring *= 2) {
    Block from{}, to{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      from[axis] = std::max<std::int64_t>(0, block[axis] - ring);
      to[axis] = std::min(count_[axis] - 1, block[axis] + ring);
    }
    for (std::int64_t z = from[2]; z <= to[2]; ++z) {
      for (std::int64_t y = from[1]; y <= to[1]; ++y) {
        const std::size_t begin = first[number({from[0], y, z})];
        const std::size_t end = first[number({to[0], y, z}) + 1];
        for (std::size_t s = begin; s < end; ++s) look(sorted[s]);
      }
    }
  }
  if (std::isinf(least)) look(sorted[first[number(block)] < sorted.size() ? first[number(block)] : 0]);
  return std::sqrt(least);
}

// The largest bound among so many blocks on either side.
void Coverage::spread_along(std::size_t axis, std::int64_t blocks) {
  std::size_t stride = 1;
  for (std::size_t k = 0; k < axis; ++k) stride *= static_cast<std::size_t>(count_[k]);
  const std::int64_t count = count_[axis];
  std::vector<double> line(static_cast<std::size_t>(count));
  for (std::size_t first = 0; first < reach_.size(); ++first) {
    if (first / stride % static_cast<std::size_t>(count) != 0) continue;
    for (std::int64_t k = 0; k < count; ++k) {
      line[static_cast<std::size_t>(k)] = reach_[first + static_cast<std::size_t>(k) * stride];
    }
    if (blocks >= count) {
      std::fill(line.begin(), line.end(), *std::max_element(line.begin(), line.end()));
    }
    for (std::int64_t k = 0; k < count; ++k) {
      const auto from = line.begin() + std::max<std::int64_t>(0, k - blocks);
      const auto to = line.begin() + std::min(count, k + blocks + 1);
      reach_[first + static_cast<std::size_t>(k) * stride] =
          blocks >= count ? line.front() : *std::max_element(from, to);
    }
  }
}

}  // namespace vorotool::core::volumes
