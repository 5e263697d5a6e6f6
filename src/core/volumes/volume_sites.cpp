#include "core/volumes/volume_sites.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/radix_sort.hpp"

namespace vorotool::core::volumes {

namespace {

// Seeds of a piece of work.
constexpr std::size_t seeds_a_piece = std::size_t{1} << 16;

// A coordinate on the lattice, seen from the middle of the frame.
std::int64_t relative(std::int64_t coordinate, std::int64_t middle, std::int64_t unit, std::size_t index) {
  std::int64_t difference = 0;
  if (__builtin_sub_overflow(coordinate, middle, &difference) ||
      __builtin_mul_overflow(difference, unit, &difference) || difference > wide_bound ||
      difference < -wide_bound) {
    throw tessellation::SeedTooFar(index, wide_bound);
  }
  return difference;
}

bool is_before(const Site& a, const Site& b) {
  return std::tie(a.z, a.y, a.x, a.label) < std::tie(b.z, b.y, b.x, b.label);
}

bool is_at_place_of(const Site& a, const Site& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

// The values along an axis, from the least one on.
struct Extent {
  std::int64_t low = std::numeric_limits<std::int64_t>::max();
  std::int64_t high = std::numeric_limits<std::int64_t>::min();

  void add(std::int64_t value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void add(const Extent& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
  int bits() const { return std::bit_width(static_cast<std::uint64_t>(high - low)); }
  std::int64_t largest() const { return std::max(std::abs(low), std::abs(high)); }
};

struct Extents {
  Extent x, y, z;
  std::uint32_t all_labels = 0;

  int bits() const { return x.bits() + y.bits() + z.bits(); }
  std::int64_t largest() const { return std::max({x.largest(), y.largest(), z.largest()}); }
  void add(const Site& site) {
    x.add(site.x);
    y.add(site.y);
    z.add(site.z);
    all_labels |= site.label;
  }
  void add(const Extents& other) {
    x.add(other.x);
    y.add(other.y);
    z.add(other.z);
    all_labels |= other.all_labels;
  }
  // Places in one word, in order of (z, y, x).
  std::uint64_t place_of(const Site& site) const {
    const auto along_x = static_cast<std::uint64_t>(site.x - x.low);
    const auto along_y = static_cast<std::uint64_t>(site.y - y.low);
    const auto along_z = static_cast<std::uint64_t>(site.z - z.low);
    return (along_z << y.bits() | along_y) << x.bits() | along_x;
  }
  Site site_at(std::uint64_t place, std::uint32_t label) const {
    const auto lowest = [&](int bits) {
      return static_cast<std::int64_t>(place & ((std::uint64_t{1} << bits) - 1));
    };
    Site site{x.low + lowest(x.bits()), 0, 0, label, 0};
    place >>= x.bits();
    site.y = y.low + lowest(y.bits());
    site.z = z.low + static_cast<std::int64_t>(place >> y.bits());
    return site;
  }
};

// The seeds as they were given, on the lattice.
class GivenSeeds {
 public:
  GivenSeeds(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
             std::span<const std::int64_t> z, std::span<const std::uint32_t> label, const VolumeFrame& frame)
      : x_(x),
        y_(y),
        z_(z),
        label_(label),
        unit_{frame.plane.unit.x, frame.plane.unit.y, frame.unit_z},
        middle_{frame.plane.scale * (frame.plane.x + frame.plane.middle_column()),
                frame.plane.scale * (frame.plane.y + frame.plane.middle_row()),
                frame.plane.scale * (frame.z + frame.middle_slice())} {}

  std::size_t size() const { return label_.size(); }
  std::uint32_t label(std::size_t i) const { return label_[i]; }
  std::int64_t x(std::size_t i) const { return relative(x_[i], middle_[0], unit_[0], i); }
  Site operator[](std::size_t i) const {
    return {x(i), relative(y_[i], middle_[1], unit_[1], i), relative(z_[i], middle_[2], unit_[2], i),
            label_[i], 0};
  }

 private:
  std::span<const std::int64_t> x_, y_, z_;
  std::span<const std::uint32_t> label_;
  std::array<std::int64_t, 3> unit_;
  std::array<std::int64_t, 3> middle_;
};

Extents extents_of(const GivenSeeds& seeds, unsigned threads) {
  std::vector<Extents> parts(base::piece_count(seeds.size(), seeds_a_piece));
  base::for_pieces(seeds.size(), seeds_a_piece, threads, {},
                   [&](std::size_t piece, std::size_t begin, std::size_t end) {
                     Extents found;
                     for (std::size_t i = begin; i < end; ++i) found.add(seeds[i]);
                     parts[piece] = found;
                   });
  Extents all;
  for (const Extents& part : parts) all.add(part);
  return all;
}

// Sorts by (z, y, x). Words hold the place and the number of a seed, or only the place, if that fits: then no seed but its
// label is looked up out of order.
void sort_by_place(const GivenSeeds& seeds, const Extents& extents, base::LargeArray<Site>& sites,
                   unsigned threads) {
  const std::size_t count = seeds.size();
  const auto for_all = [&](const auto& body) { base::for_items(count, seeds_a_piece, threads, {}, body); };
  const int bits = extents.bits(), number_bits = std::bit_width(count);
  if (bits > 63) {
    for_all([&](std::size_t s) { sites[s] = seeds[s]; });
    std::sort(sites.data(), sites.data() + count, is_before);
  } else if (bits + number_bits <= 64) {
    std::vector<std::uint64_t> words(count);
    for_all([&](std::size_t s) { words[s] = extents.place_of(seeds[s]) << number_bits | s; });
    base::radix_sort(words, number_bits, number_bits + bits, threads);
    const std::uint64_t mask = (std::uint64_t{1} << number_bits) - 1;
    for_all([&](std::size_t s) {
      sites[s] = extents.site_at(words[s] >> number_bits, seeds.label(words[s] & mask));
    });
  } else {
    std::vector<base::Keyed> items(count);
    for_all([&](std::size_t s) { items[s] = {extents.place_of(seeds[s]), static_cast<std::uint32_t>(s)}; });
    base::radix_sort(items, bits, threads);
    for_all([&](std::size_t s) { sites[s] = extents.site_at(items[s].key, seeds.label(items[s].value)); });
  }
}

// Of the sites at one place, which follow each other, the one with the smallest label stays; gives how many stay.
std::size_t drop_duplicates(std::span<Site> sites, unsigned threads) {
  std::vector<char> has_some(base::piece_count(sites.size(), seeds_a_piece));
  base::for_pieces(sites.size(), seeds_a_piece, threads, {},
                   [&](std::size_t piece, std::size_t begin, std::size_t end) {
                     for (std::size_t s = std::max<std::size_t>(begin, 1); s < end; ++s) {
                       if (is_at_place_of(sites[s - 1], sites[s])) has_some[piece] = 1;
                     }
                   });
  if (std::find(has_some.begin(), has_some.end(), 1) == has_some.end()) return sites.size();
  std::size_t kept = 1;
  for (std::size_t s = 1; s < sites.size(); ++s) {
    Site& last = sites[kept - 1];
    if (is_at_place_of(last, sites[s])) {
      last.label = std::min(last.label, sites[s].label);
    } else {
      sites[kept++] = sites[s];
    }
  }
  return kept;
}

// Numbers the distinct x in increasing order by counting along the extent; gives how many there are.
std::int32_t count_columns(const GivenSeeds& seeds, std::span<Site> sites, const Extent& along_x,
                           unsigned threads) {
  std::vector<std::int32_t> column(static_cast<std::size_t>(along_x.high - along_x.low) + 1, 0);
  for (std::size_t i = 0; i < seeds.size(); ++i)
    column[static_cast<std::size_t>(seeds.x(i) - along_x.low)] = 1;
  std::int32_t columns = 0;
  for (std::int32_t& is_one : column) columns += std::exchange(is_one, columns);
  base::for_items(sites.size(), seeds_a_piece, threads, {}, [&](std::size_t s) {
    sites[s].column = column[static_cast<std::size_t>(sites[s].x - along_x.low)];
  });
  return columns;
}

// The same by sorting, where the extent is long.
std::int32_t sort_columns(std::span<Site> sites, const Extent& along_x, unsigned threads) {
  std::vector<base::Keyed> items(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) {
    items[s] = {static_cast<std::uint64_t>(sites[s].x - along_x.low), static_cast<std::uint32_t>(s)};
  }
  base::radix_sort(items, along_x.bits(), threads);
  std::int32_t column = 0;
  for (std::size_t k = 0; k < items.size(); ++k) {
    column += k > 0 && items[k].key != items[k - 1].key;
    sites[items[k].value].column = column;
  }
  return column + 1;
}

std::int32_t number_columns(const GivenSeeds& seeds, std::span<Site> sites, const Extent& along_x,
                            unsigned threads) {
  constexpr std::int64_t short_extent = std::int64_t{1} << 16;
  const auto count = static_cast<std::int64_t>(sites.size());
  const bool is_short = along_x.high - along_x.low <= std::max(short_extent, 2 * count);
  return is_short ? count_columns(seeds, sites, along_x, threads) : sort_columns(sites, along_x, threads);
}

}  // namespace

VolumeSites prepare_sites(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
                          std::span<const std::int64_t> z, std::span<const std::uint32_t> label,
                          const VolumeFrame& frame, unsigned threads) {
  if (x.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw std::length_error("more than 2147483647 seeds");
  }
  const auto& plane = frame.plane;
  VolumeSites made{};
  made.largest_coordinate = std::max({std::int64_t{plane.pixel().x} * (plane.middle_column() + 1),
                                      std::int64_t{plane.pixel().y} * (plane.middle_row() + 1),
                                      std::int64_t{frame.step_z()} * (frame.middle_slice() + 1)});
  if (x.empty()) return made;
  const GivenSeeds seeds(x, y, z, label, frame);
  const Extents extents = extents_of(seeds, threads);
  made.largest_coordinate = std::max(made.largest_coordinate, extents.largest());
  made.all_labels = extents.all_labels;
  made.room = base::LargeArray<Site>(seeds.size());
  sort_by_place(seeds, extents, made.room, threads);
  const std::span<Site> sorted(made.room.data(), seeds.size());
  const std::span<Site> sites = sorted.first(drop_duplicates(sorted, threads));
  made.duplicates = seeds.size() - sites.size();
  made.columns = number_columns(seeds, sites, extents.x, threads);
  made.sites = sites;
  return made;
}

}  // namespace vorotool::core::volumes
