#include "core/volumes/seed_tiles.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/volumes/nearest_kernel.hpp"

namespace vorotool::core::volumes {

namespace {

// The part of the voxels that may be farther from their seed than the likely reach.
constexpr double part_beyond = 2e-5;

std::int64_t floor_over(std::int64_t a, std::int64_t positive) {
  return a / positive - (a % positive < 0 ? 1 : 0);
}

// The seeds of one tile in some slices.
std::span<const TileSeed> between(std::span<const TileSeed> seeds, std::int64_t first, std::int64_t last) {
  const auto from = std::partition_point(seeds.begin(), seeds.end(),
                                         [&](const TileSeed& seed) { return seed.slice < first; });
  const auto to =
      std::partition_point(from, seeds.end(), [&](const TileSeed& seed) { return seed.slice <= last; });
  return {from, to};
}

}  // namespace

bool SeedTiles::suits(const VolumeSites& sites, const VolumeFrame& frame) {
  if (sites.largest_coordinate > exact_product_bound) return false;
  std::uint32_t labels = 0;
  for (const Site& site : sites.sites) {
    if (site.z % frame.step_z() != 0) return false;
    labels |= site.label;
  }
  // the distance that surely suffices is less than 4 N, and is passed by less than its half and a group's side
  const int square_bits = 2 * std::bit_width(static_cast<std::uint64_t>(sites.largest_coordinate)) + 9;
  return square_bits + std::bit_width(labels) < 63;
}

SeedTiles::SeedTiles(std::span<const Site> sites, const VolumeFrame& frame)
    : frame_(frame),
      step_x_(frame.plane.pixel().x),
      step_y_(frame.plane.pixel().y),
      step_z_(frame.step_z()),
      across_((frame.plane.width + tile_width - 1) / tile_width),
      down_((frame.plane.height + tile_height - 1) / tile_height),
      first_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_) + 1),
      seeds_(sites.size()) {
  const auto tile_of = [&](const Site& site) {
    return static_cast<std::size_t>(tile_down(site.y)) * static_cast<std::size_t>(across_) +
           static_cast<std::size_t>(tile_across(site.x));
  };
  std::vector<std::uint32_t> tile(sites.size());
  std::uint32_t labels = 0;
  for (std::size_t s = 0; s < sites.size(); ++s) {
    tile[s] = static_cast<std::uint32_t>(tile_of(sites[s]));
    ++first_[tile[s] + 1];
    labels |= sites[s].label;
  }
  label_bits_ = std::bit_width(labels);
  for (std::size_t t = 1; t < first_.size(); ++t) first_[t] += first_[t - 1];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t s = 0; s < sites.size(); ++s) {
    const Site& site = sites[s];
    seeds_[next[tile[s]]++] = {static_cast<std::int32_t>(site.x), static_cast<std::int32_t>(site.y),
                               static_cast<std::int32_t>(site.z / step_z_) + frame.middle_slice(),
                               site.label};
  }
}

// The tile of a coordinate; of one outside the frame the nearest.
std::int32_t SeedTiles::tile_across(std::int64_t x) const {
  const std::int64_t column = floor_over(x, step_x_) + frame_.plane.middle_column();
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(floor_over(column, tile_width), 0, across_ - 1));
}

std::int32_t SeedTiles::tile_down(std::int64_t y) const {
  const std::int64_t row = floor_over(y, step_y_) + frame_.plane.middle_row();
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(floor_over(row, tile_height), 0, down_ - 1));
}

std::span<const TileSeed> SeedTiles::of_tile(std::int32_t across, std::int32_t down) const {
  const auto tile =
      static_cast<std::size_t>(down) * static_cast<std::size_t>(across_) + static_cast<std::size_t>(across);
  return {seeds_.data() + first_[tile], seeds_.data() + first_[tile + 1]};
}

void SeedTiles::gather(const Box& box, std::int32_t distance, std::vector<TileSeed>& found,
                       std::vector<std::int32_t>& first) const {
  const std::int64_t left = std::int64_t{x_of(box.columns.first)} - distance;
  const std::int64_t right = std::int64_t{x_of(box.columns.last)} + distance;
  const std::int64_t top = std::int64_t{y_of(box.rows.first)} - distance;
  const std::int64_t bottom = std::int64_t{y_of(box.rows.last)} + distance;
  const std::int32_t reach = distance / step_z_;
  const std::int32_t lowest = box.slices.first - reach;
  const std::int32_t highest = box.slices.last + reach;
  first.assign(static_cast<std::size_t>(highest - lowest) + 2, 0);
  const auto for_each = [&](auto take) {
    for (std::int32_t down = tile_down(top); down <= tile_down(bottom); ++down) {
      for (std::int32_t across = tile_across(left); across <= tile_across(right); ++across) {
        for (const TileSeed& seed : between(of_tile(across, down), lowest, highest)) {
          if (seed.x < left || seed.x > right || seed.y < top || seed.y > bottom) continue;
          take(seed, static_cast<std::size_t>(seed.slice - lowest));
        }
      }
    }
  };
  for_each([&](const TileSeed&, std::size_t slice) { ++first[slice + 1]; });
  for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
  found.resize(static_cast<std::size_t>(first.back()));
  // each slice's first seed moves to the next one's, and then back
  for_each([&](const TileSeed& seed, std::size_t slice) {
    found[static_cast<std::size_t>(first[slice]++)] = seed;
  });
  std::copy_backward(first.begin(), first.end() - 1, first.end());
  first.front() = 0;
}

double SeedTiles::likely_reach(const Box& box) const {
  const std::int32_t left = std::max(0, box.columns.first / tile_width - 1);
  const std::int32_t right = std::min(across_ - 1, box.columns.last / tile_width + 1);
  const std::int32_t top = std::max(0, box.rows.first / tile_height - 1);
  const std::int32_t bottom = std::min(down_ - 1, box.rows.last / tile_height + 1);
  double seeds = 1;
  for (std::int32_t down = top; down <= bottom; ++down) {
    for (std::int32_t across = left; across <= right; ++across) {
      seeds += static_cast<double>(between(of_tile(across, down), box.slices.first, box.slices.last).size());
    }
  }
  const double columns = std::min((right - left + 1) * tile_width, frame_.plane.width);
  const double rows = std::min((bottom - top + 1) * tile_height, frame_.plane.height);
  const double volume = columns * rows * box.slices.count() * step_x_ * step_y_ * step_z_;
  return std::cbrt(-std::log(part_beyond) * 0.75 * std::numbers::inv_pi * volume / seeds);
}

// Fitted to what 512^3 voxels take on one thread: planes that are merged, and what is done once a voxel.
double SeedTiles::nanoseconds_a_voxel(Range slices, double most_distance) const {
  constexpr double a_voxel = 1.5, a_plane = 0.12;
  double sum = 0, voxels = 0;
  for (std::int32_t s = 0; s < count_parts(slices, box_slices); ++s) {
    for (std::int32_t down = 0; down < down_; ++down) {
      for (std::int32_t across = 0; across < across_; ++across) {
        const Box box{part_of(columns(), across, tile_width), part_of(rows(), down, tile_height),
                      part_of(slices, s, box_slices)};
        const double reach = std::min(likely_reach(box), most_distance) / step_z_;
        sum += box.voxels() * (a_voxel + a_plane * (2 * reach + 1));
        voxels += box.voxels();
      }
    }
  }
  return sum / voxels;
}

// Tiles by rings around that of the voxel, until a ring is farther than what was found.
Nearest SeedTiles::nearest(std::int32_t column, std::int32_t row, std::int32_t slice) const {
  const std::int64_t x = x_of(column), y = y_of(row);
  const std::int32_t here = column / tile_width, there = row / tile_height;
  constexpr std::int64_t far = std::int64_t{1} << 30;
  Nearest best{std::numeric_limits<std::int64_t>::max(), 0};
  const auto look = [&](std::int32_t across, std::int32_t down) {
    const auto seeds = of_tile(across, down);
    const auto try_one = [&](const TileSeed& seed) {
      const std::int64_t dz = std::int64_t{step_z_} * (seed.slice - slice);
      const std::int64_t square = (seed.x - x) * (seed.x - x) + (seed.y - y) * (seed.y - y) + dz * dz;
      if (square < best.square || (square == best.square && seed.label < best.label)) {
        best = {square, seed.label};
      }
      return dz * dz <= best.square;
    };
    const auto middle = std::partition_point(seeds.begin(), seeds.end(),
                                             [&](const TileSeed& seed) { return seed.slice < slice; });
    for (auto seed = middle; seed != seeds.end() && try_one(*seed);) ++seed;
    for (auto seed = middle; seed != seeds.begin() && try_one(*(seed - 1));) --seed;
  };
  for (std::int32_t ring = 0; ring < std::max(across_, down_); ++ring) {
    // seeds of this ring and the next ones are beyond the sides of the ones before
    const std::int64_t beyond =
        std::min({here < ring ? far : x - x_of((here - ring + 1) * tile_width),
                  here + ring >= across_ ? far : x_of((here + ring) * tile_width) - x,
                  there < ring ? far : y - y_of((there - ring + 1) * tile_height),
                  there + ring >= down_ ? far : y_of((there + ring) * tile_height) - y});
    if (ring > 0 && best.label > 0 && beyond * beyond > best.square) break;
    for (std::int32_t down = there - ring; down <= there + ring; ++down) {
      if (down < 0 || down >= down_) continue;
      const bool whole = down == there - ring || down == there + ring;
      for (std::int32_t across = here - ring; across <= here + ring;
           across += whole || ring == 0 ? 1 : 2 * ring) {
        if (across >= 0 && across < across_) look(across, down);
      }
    }
  }
  return best;
}

}  // namespace vorotool::core::volumes
