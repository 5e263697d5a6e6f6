#include "core/tessellation/sorted_seeds.hpp"

#include <bit>
#include <limits>
#include <string>

#include "core/base/radix_sort.hpp"
#include "core/numbers/int128.hpp"
#include "core/tessellation/sweep_arithmetic.hpp"

namespace vorotool::core::tessellation {

using base::Keyed;
using base::radix_sort;
using numbers::int128;

SeedTooFar::SeedTooFar(std::size_t index_, std::int64_t bound_)
    : std::range_error("seed " + std::to_string(index_) + " is too far from the frame"),
      index(index_),
      bound(bound_) {}

namespace {

// A seed relative to the middle of the frame.
struct Seed {
  std::int64_t y, x;
  std::uint32_t label;

  bool operator<(const Seed& other) const { return y != other.y ? y < other.y : x < other.x; }
};

// The seeds as they were given, seen from the middle of the frame, and their bounds.
class RelativeSeeds {
 public:
  RelativeSeeds(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
                std::span<const std::uint32_t> label, const FrameOnLattice& frame)
      : x_(x),
        y_(y),
        label_(label),
        middle_x_(frame.scale * (frame.x + frame.middle_column())),
        middle_y_(frame.scale * (frame.y + frame.middle_row())),
        unit_(frame.unit) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Bounds seed{relative(x[i], middle_x_, unit_.x, i), relative(y[i], middle_y_, unit_.y, i)};
      least_ = {std::min(least_.x, seed.x), std::min(least_.y, seed.y)};
      most_ = {std::max(most_.x, seed.x), std::max(most_.y, seed.y)};
    }
  }

  std::size_t size() const { return x_.size(); }
  std::int64_t least_x() const { return least_.x; }
  std::int64_t least_y() const { return least_.y; }
  // Corners of the box that holds the seeds and the middle of the frame.
  Seed least() const { return {least_.y, least_.x, 0}; }
  Seed most() const { return {most_.y, most_.x, 0}; }
  std::uint64_t x_range() const { return static_cast<std::uint64_t>(most_.x - least_.x); }
  std::uint64_t y_range() const { return static_cast<std::uint64_t>(most_.y - least_.y); }
  std::int64_t largest_coordinate() const { return std::max({-least_.x, most_.x, -least_.y, most_.y}); }
  // Within the bounds also where somebody writes to the seeds meanwhile: places in tables hang on that.
  Seed operator[](std::size_t i) const {
    return {std::clamp(wrapped(y_[i], middle_y_, unit_.y), least_.y, most_.y),
            std::clamp(wrapped(x_[i], middle_x_, unit_.x), least_.x, most_.x), label_[i]};
  }

 private:
  struct Bounds {
    std::int64_t x, y;
  };

  static std::int64_t wrapped(std::int64_t coordinate, std::int64_t middle, std::int64_t unit) {
    return static_cast<std::int64_t>(
        (static_cast<std::uint64_t>(coordinate) - static_cast<std::uint64_t>(middle)) *
        static_cast<std::uint64_t>(unit));
  }

  static std::int64_t relative(std::int64_t coordinate, std::int64_t middle, std::int64_t unit,
                               std::size_t index) {
    std::int64_t difference = 0;
    if (__builtin_sub_overflow(coordinate, middle, &difference) ||
        __builtin_mul_overflow(difference, unit, &difference) || difference > wide_bound ||
        difference < -wide_bound) {
      throw SeedTooFar(index, wide_bound);
    }
    return difference;
  }

  std::span<const std::int64_t> x_, y_;
  std::span<const std::uint32_t> label_;
  std::int64_t middle_x_, middle_y_;
  Steps unit_;
  Bounds least_{0, 0}, most_{0, 0};  // the middle of the frame is within the bounds
};

// Squared distance from a seed to the nearest or the farthest point of the frame; below 2^83 by wide_bound.
class FrameDistance {
 public:
  explicit FrameDistance(const FrameOnLattice& frame)
      : left_(-frame.pixel().x * frame.middle_column()),
        right_(left_ + frame.pixel().x * (frame.width - 1)),
        top_(frame.row_y(0)),
        bottom_(frame.row_y(frame.height - 1)) {}

  bool is_inside(const Seed& seed) const {
    return seed.x >= left_ && seed.x <= right_ && seed.y >= top_ && seed.y <= bottom_;
  }
  int128 least(const Seed& seed) const {
    return sum_of_squares(seed.x - std::clamp(seed.x, left_, right_),
                          seed.y - std::clamp(seed.y, top_, bottom_));
  }
  int128 most(const Seed& seed) const {
    return sum_of_squares(std::max(std::abs(seed.x - left_), std::abs(seed.x - right_)),
                          std::max(std::abs(seed.y - top_), std::abs(seed.y - bottom_)));
  }

 private:
  static int128 sum_of_squares(std::int64_t dx, std::int64_t dy) { return int128{dx} * dx + int128{dy} * dy; }

  std::int64_t left_, right_, top_, bottom_;
};

// A seed that is farther from every pixel than some other seed from all of them is nearest nowhere, and only
// costs time. This is the distance that such a seed exceeds: the least of the farthest distances.
int128 farthest_useful(const RelativeSeeds& seeds, const FrameDistance& distance) {
  int128 limit = distance.most(seeds[0]);
  for (std::size_t i = 1; i < seeds.size(); ++i) limit = std::min(limit, distance.most(seeds[i]));
  return limit;
}

// Calls take(seed) for the seeds in order of (y, x). Where the ranges of both fit one key, a radix sort moves
// the labels along with the keys, and no seed is looked up out of order.
template <class Take>
void for_each_in_sweep_order(const RelativeSeeds& seeds, Take take) {
  const int x_bits = std::bit_width(seeds.x_range());
  const int y_bits = std::bit_width(seeds.y_range());
  if (x_bits + y_bits > 63) {
    std::vector<Seed> sorted(seeds.size());
    for (std::size_t i = 0; i < seeds.size(); ++i) sorted[i] = seeds[i];
    std::sort(sorted.begin(), sorted.end());
    std::for_each(sorted.begin(), sorted.end(), take);
    return;
  }
  const auto take_key = [&](std::uint64_t key, std::uint32_t label) {
    const std::uint64_t x = key & ((std::uint64_t{1} << x_bits) - 1);
    take(Seed{seeds.least_y() + static_cast<std::int64_t>(key >> x_bits),
              seeds.least_x() + static_cast<std::int64_t>(x), label});
  };
  const auto key_of = [&](const Seed& seed) {
    const auto above = static_cast<std::uint64_t>(seed.y - seeds.least_y());
    return above << x_bits | static_cast<std::uint64_t>(seed.x - seeds.least_x());
  };
  if (x_bits + y_bits <= 32) {  // key and label fit one word
    std::vector<std::uint64_t> words(seeds.size());
    for (std::size_t i = 0; i < seeds.size(); ++i) words[i] = key_of(seeds[i]) << 32 | seeds[i].label;
    radix_sort(words, 32, 32 + x_bits + y_bits);
    for (const std::uint64_t word : words) take_key(word >> 32, static_cast<std::uint32_t>(word));
    return;
  }
  std::vector<Keyed> items(seeds.size());
  for (std::size_t i = 0; i < seeds.size(); ++i) items[i] = {key_of(seeds[i]), seeds[i].label};
  radix_sort(items, x_bits + y_bits);
  for (const Keyed& item : items) take_key(item.key, item.value);
}

// Numbers distinct x coordinates (given as offsets from the least) by a table over their range.
std::vector<std::int64_t> number_by_table(const std::vector<std::uint64_t>& x, std::uint64_t range,
                                          std::vector<std::int32_t>& column) {
  std::vector<std::int64_t> distinct;
  std::vector<std::int32_t> number(range + 1, 0);
  for (const std::uint64_t offset : x) number[offset] = 1;
  for (std::size_t offset = 0; offset <= range; ++offset) {
    if (number[offset] == 0) continue;
    number[offset] = static_cast<std::int32_t>(distinct.size());
    distinct.push_back(static_cast<std::int64_t>(offset));
  }
  std::transform(x.begin(), x.end(), column.begin(), [&](std::uint64_t offset) { return number[offset]; });
  return distinct;
}

// The same by sorting, where the range is wide.
std::vector<std::int64_t> number_by_sorting(const std::vector<std::uint64_t>& x, std::uint64_t range,
                                            std::vector<std::int32_t>& column) {
  std::vector<std::int64_t> distinct;
  std::vector<Keyed> items(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) items[k] = {x[k], static_cast<std::uint32_t>(k)};
  radix_sort(items, std::bit_width(range));
  for (const Keyed& item : items) {
    const auto offset = static_cast<std::int64_t>(item.key);
    if (distinct.empty() || distinct.back() != offset) distinct.push_back(offset);
    column[item.value] = static_cast<std::int32_t>(distinct.size() - 1);
  }
  return distinct;
}

}  // namespace

Sites prepare_sites(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
                    std::span<const std::uint32_t> label, const FrameOnLattice& frame) {
  if (x.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw std::length_error("more than 2147483647 seeds");
  }
  const RelativeSeeds seeds(x, y, label, frame);
  Sites sites;
  std::vector<std::uint64_t> offsets;  // x of each site from the least
  sites.y.reserve(x.size());
  sites.label.reserve(x.size());
  offsets.reserve(x.size());
  const FrameDistance distance(frame);
  const bool all_inside = distance.is_inside(seeds.least()) && distance.is_inside(seeds.most());
  const int128 limit = all_inside ? 0 : farthest_useful(seeds, distance);
  std::size_t useless = 0;
  for_each_in_sweep_order(seeds, [&](const Seed& seed) {
    if (!all_inside && distance.least(seed) > limit) {
      ++useless;
      return;
    }
    const auto offset = static_cast<std::uint64_t>(seed.x - seeds.least_x());
    if (!offsets.empty() && sites.y.back() == seed.y && offsets.back() == offset) {
      sites.label.back() = std::min(sites.label.back(), seed.label);
      return;
    }
    sites.y.push_back(seed.y);
    sites.label.push_back(seed.label);
    offsets.push_back(offset);
  });
  sites.duplicates = x.size() - sites.size() - useless;
  sites.column.resize(sites.size());
  const bool table = seeds.x_range() <= 4 * sites.size() + 65536;
  sites.column_x = (table ? number_by_table : number_by_sorting)(offsets, seeds.x_range(), sites.column);
  for (std::int64_t& column : sites.column_x) column += seeds.least_x();
  sites.largest_coordinate =
      std::max({seeds.largest_coordinate(), frame.pixel().x * (frame.middle_column() + 1),
                frame.pixel().y * (frame.middle_row() + 1)});
  return sites;
}

}  // namespace vorotool::core::tessellation
