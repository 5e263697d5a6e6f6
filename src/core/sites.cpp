#include "core/sites.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <string>

#include "core/arithmetic.hpp"
#include "core/radix_sort.hpp"

namespace vorotool::core {

SeedTooFar::SeedTooFar(std::size_t index_, std::int64_t bound_)
    : std::range_error("seed " + std::to_string(index_) + " is too far from the frame"),
      index(index_),
      bound(bound_) {}

namespace {

// Coordinates of the seeds relative to the middle of the frame, and their bounds.
struct Relative {
  std::vector<std::int64_t> x, y;
  std::int64_t least_x, most_x, least_y, most_y;
};

Relative relative_to_middle(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
                            const FrameOnLattice& frame) {
  const std::int64_t middle_x = frame.steps * (frame.x + frame.middle_column());
  const std::int64_t middle_y = frame.steps * (frame.y + frame.middle_row());
  Relative seeds{std::vector<std::int64_t>(x.size()), std::vector<std::int64_t>(x.size()), 0, 0, 0, 0};
  for (std::size_t i = 0; i < x.size(); ++i) {
    std::int64_t dx = 0;
    std::int64_t dy = 0;
    if (__builtin_sub_overflow(x[i], middle_x, &dx) || __builtin_sub_overflow(y[i], middle_y, &dy) ||
        dx > wide_bound || dx < -wide_bound || dy > wide_bound || dy < -wide_bound) {
      throw SeedTooFar(i, wide_bound);
    }
    seeds.x[i] = dx;
    seeds.y[i] = dy;
    seeds.least_x = std::min(seeds.least_x, dx);
    seeds.most_x = std::max(seeds.most_x, dx);
    seeds.least_y = std::min(seeds.least_y, dy);
    seeds.most_y = std::max(seeds.most_y, dy);
  }
  return seeds;
}

// Order of the seeds by (y, x); seeds at one place stay in the order of the input.
std::vector<std::uint32_t> sweep_order(const Relative& seeds) {
  const std::size_t n = seeds.x.size();
  const int x_bits = std::bit_width(static_cast<std::uint64_t>(seeds.most_x - seeds.least_x));
  const int y_bits = std::bit_width(static_cast<std::uint64_t>(seeds.most_y - seeds.least_y));
  std::vector<std::uint32_t> order(n);
  if (x_bits + y_bits <= 64) {
    std::vector<KeyedIndex> items(n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto dx = static_cast<std::uint64_t>(seeds.x[i] - seeds.least_x);
      const auto dy = static_cast<std::uint64_t>(seeds.y[i] - seeds.least_y);
      items[i] = {x_bits == 64 ? dx : dy << x_bits | dx, static_cast<std::uint32_t>(i)};
    }
    radix_sort(items, x_bits + y_bits);
    std::transform(items.begin(), items.end(), order.begin(),
                   [](const KeyedIndex& item) { return item.index; });
  } else {
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return seeds.y[a] != seeds.y[b] ? seeds.y[a] < seeds.y[b] : seeds.x[a] < seeds.x[b];
    });
  }
  return order;
}

// Numbers the distinct x coordinates in increasing order: by a table over their range where that is small.
std::vector<std::int64_t> number_columns(const Relative& seeds, const std::vector<std::uint32_t>& kept,
                                         std::vector<std::int32_t>& column) {
  std::vector<std::int64_t> distinct;
  column.resize(kept.size());
  const auto range = static_cast<std::uint64_t>(seeds.most_x - seeds.least_x) + 1;
  if (range <= 4 * kept.size() + 65536) {
    std::vector<std::int32_t> number(range, 0);
    for (const std::uint32_t i : kept) number[static_cast<std::size_t>(seeds.x[i] - seeds.least_x)] = 1;
    for (std::size_t k = 0; k < range; ++k) {
      if (number[k] == 0) continue;
      number[k] = static_cast<std::int32_t>(distinct.size());
      distinct.push_back(seeds.least_x + static_cast<std::int64_t>(k));
    }
    for (std::size_t k = 0; k < kept.size(); ++k) {
      column[k] = number[static_cast<std::size_t>(seeds.x[kept[k]] - seeds.least_x)];
    }
    return distinct;
  }
  std::vector<KeyedIndex> items(kept.size());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    items[k] = {static_cast<std::uint64_t>(seeds.x[kept[k]] - seeds.least_x), static_cast<std::uint32_t>(k)};
  }
  radix_sort(items, std::bit_width(range));
  for (const KeyedIndex& item : items) {
    const std::int64_t x = seeds.least_x + static_cast<std::int64_t>(item.key);
    if (distinct.empty() || distinct.back() != x) distinct.push_back(x);
    column[item.index] = static_cast<std::int32_t>(distinct.size() - 1);
  }
  return distinct;
}

}  // namespace

Sites prepare_sites(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
                    std::span<const std::uint32_t> label, const FrameOnLattice& frame) {
  if (x.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw std::length_error("more than 2147483647 seeds");
  }
  const Relative seeds = relative_to_middle(x, y, frame);
  std::vector<std::uint32_t> kept = sweep_order(seeds);
  Sites sites;
  sites.y.reserve(x.size());
  sites.label.reserve(x.size());
  std::size_t count = 0;
  for (const std::uint32_t i : kept) {
    if (count > 0 && seeds.y[i] == seeds.y[kept[count - 1]] && seeds.x[i] == seeds.x[kept[count - 1]]) {
      sites.label.back() = std::min(sites.label.back(), label[i]);
      continue;
    }
    kept[count++] = i;
    sites.y.push_back(seeds.y[i]);
    sites.label.push_back(label[i]);
  }
  sites.duplicates = x.size() - count;
  kept.resize(count);
  sites.column_x = number_columns(seeds, kept, sites.column);
  sites.largest_coordinate = std::max({-seeds.least_x, seeds.most_x, -seeds.least_y, seeds.most_y,
                                       std::int64_t{frame.steps} * (frame.middle_column() + 1),
                                       std::int64_t{frame.steps} * (frame.middle_row() + 1)});
  return sites;
}

}  // namespace vorotool::core
