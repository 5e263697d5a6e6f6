#include "core/thickness/local_thickness.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/thickness/covering_arc.hpp"

// A place that a disc centered on an arc covers is covered by the disc of the arc's upper node, or is in the
// arc's crescent. The upper node is a summit, or the lower node of another arc. So it is enough to draw the
// discs of all summits, and to look at the arcs that places in their crescents are covered from.
//
// Larger discs come first: what one covers is final, and later discs skip it. The crescents of a path down from
// a summit are disjoint; a pixel in several is looked at for each whose upper disc is larger than what covers
// it.
namespace vorotool::core::thickness {

using kernel::Point;
using skeleton::SkeletonView;

namespace {

constexpr std::size_t band_rows = 64;
constexpr std::size_t samples_a_piece = 1 << 12;
constexpr double margin_in_pixels = 1e-6;

// Pixels from first to before last.
struct Range {
  std::int32_t first = 0, last = 0;

  bool is_empty() const { return first >= last; }
};

// The pixels whose centers are in an interval, of `count` ones.
Range pixels_in(const Interval& interval, double first, double step, std::size_t count) {
  if (!(interval.first <= interval.last)) return {};
  const double most = static_cast<double>(count);
  const double from = std::ceil((interval.first - first) / step);
  const double to = std::floor((interval.last - first) / step) + 1;
  if (!(from < most && to > 0)) return {};
  return {static_cast<std::int32_t>(std::max(from, 0.0)), static_cast<std::int32_t>(std::min(to, most))};
}

// A node's disc, or an arc's crescent, and the rows that it is in.
struct Item {
  double radius;  // the largest that it gives a pixel
  std::int32_t index;
  Range rows;
};

// Those of each band, larger radii first.
class Bands {
 public:
  Bands(std::vector<Item>&& items, std::size_t count) : items_(std::move(items)), start_(count + 1) {
    std::sort(items_.begin(), items_.end(), [](const Item& a, const Item& b) {
      return a.radius > b.radius || (a.radius == b.radius && a.index < b.index);
    });
    for_each([&](std::size_t band, std::size_t) { ++start_[band + 1]; });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    member_.resize(start_.back());
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for_each([&](std::size_t band, std::size_t item) { member_[next[band]++] = item; });
  }

  template <class Body>
  void in_band(std::size_t band, const Body& body) const {
    for (std::size_t i = start_[band]; i < start_[band + 1]; ++i) body(items_[member_[i]]);
  }

 private:
  template <class Body>
  void for_each(const Body& body) const {
    for (std::size_t item = 0; item < items_.size(); ++item) {
      const auto first = static_cast<std::size_t>(items_[item].rows.first);
      const auto last = static_cast<std::size_t>(items_[item].rows.last);
      for (std::size_t band = first / band_rows; band * band_rows < last; ++band) body(band, item);
    }
  }

  std::vector<Item> items_;
  std::vector<std::size_t> start_, member_;  // [bands + 1], [start_.back()]
};

class Raster {
 public:
  Raster(const SkeletonView& skeleton, const PixelCenters& pixels, double slack)
      : skeleton_(skeleton),
        pixels_(pixels),
        slack_(slack),
        margin_(margin_in_pixels * std::min(pixels.step.x, pixels.step.y) + slack) {}

  std::vector<Item> summits() const;
  std::vector<Item> crescents(unsigned threads, const base::Monitor& monitor) const;
  // Both write radii: the rows of a band begin at `radii`.
  void draw_discs(const Bands& summits, std::size_t band, double* radii) const;
  void draw_crescents(const Bands& crescents, std::size_t band, double* radii) const;

 private:
  Range rows_in(const Interval& interval) const {
    return pixels_in(interval, pixels_.first.y, pixels_.step.y, pixels_.height);
  }
  Range columns_in(const Interval& interval) const {
    return pixels_in(interval, pixels_.first.x, pixels_.step.x, pixels_.width);
  }
  Range rows_of_disc(std::size_t node) const;
  Range columns_of_disc(std::size_t node, std::size_t row) const;
  Range rows_of_crescent(const Crescent& crescent) const;
  double row_y(std::size_t row) const { return pixels_.place(0, row).y; }
  Range rows_in_band(const Item& item, std::size_t band) const;

  const SkeletonView& skeleton_;
  const PixelCenters& pixels_;
  double slack_, margin_;
};

std::vector<Item> Raster::summits() const {
  enum : std::uint8_t { unused, summit, lower };
  std::vector<std::uint8_t> kind(skeleton_.radius.size(), unused);
  for (const auto& [source, target] : skeleton_.arcs) {
    const bool falls = is_upper(skeleton_, source, target);
    std::uint8_t& up = kind[static_cast<std::size_t>(falls ? source : target)];
    up = std::max<std::uint8_t>(up, summit);
    if (source != target) kind[static_cast<std::size_t>(falls ? target : source)] = lower;
  }
  std::vector<Item> found;
  for (std::size_t node = 0; node < kind.size(); ++node) {
    if (kind[node] != summit) continue;
    const Range rows = rows_of_disc(node);
    if (!rows.is_empty()) found.push_back({skeleton_.radius[node], static_cast<std::int32_t>(node), rows});
  }
  return found;
}

std::vector<Item> Raster::crescents(unsigned threads, const base::Monitor& monitor) const {
  const std::size_t count = skeleton_.arcs.size();
  std::vector<std::vector<Item>> found(base::piece_count(count, samples_a_piece));
  base::for_pieces(
      count, samples_a_piece, threads, monitor, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        for (std::size_t arc = begin; arc < end; ++arc) {
          const CoveringArc covering(skeleton_, arc, slack_);
          const Range rows = rows_of_crescent(covering.crescent(margin_));
          if (!rows.is_empty())
            found[piece].push_back({covering.upper().radius, static_cast<std::int32_t>(arc), rows});
        }
      });
  std::vector<Item> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

Range Raster::rows_of_disc(std::size_t node) const {
  const double y = skeleton_.vertices[node].y, radius = skeleton_.radius[node] + slack_;
  return rows_in({y - radius, y + radius});
}

Range Raster::columns_of_disc(std::size_t node, std::size_t row) const {
  const Point& center = skeleton_.vertices[node];
  const double radius = skeleton_.radius[node] + slack_, up = row_y(row) - center.y;
  const double half = std::sqrt(std::max(0.0, radius * radius - up * up));
  return columns_in({center.x - half, center.x + half});
}

// Rows without pixels are left out at both ends: most crescents are between the centers of pixels.
Range Raster::rows_of_crescent(const Crescent& crescent) const {
  Range rows = rows_in(crescent.rows());
  const auto is_empty = [&](std::int32_t row) {
    return columns_in(crescent.columns(row_y(static_cast<std::size_t>(row)))).is_empty();
  };
  while (!rows.is_empty() && is_empty(rows.first)) ++rows.first;
  while (!rows.is_empty() && is_empty(rows.last - 1)) --rows.last;
  return rows;
}

Range Raster::rows_in_band(const Item& item, std::size_t band) const {
  const auto first = static_cast<std::int32_t>(band * band_rows);
  return {std::max(item.rows.first, first),
          std::min(item.rows.last, first + static_cast<std::int32_t>(band_rows))};
}

void Raster::draw_discs(const Bands& summits, std::size_t band, double* radii) const {
  const std::size_t width = pixels_.width, stride = width + 1;
  // the next pixel of a row that nothing covers yet, at the latest behind its end; halved while it is followed
  std::vector<std::int32_t> next(stride * band_rows);
  for (std::size_t i = 0; i < next.size(); ++i) next[i] = static_cast<std::int32_t>(i % stride);
  summits.in_band(band, [&](const Item& item) {
    const Range rows = rows_in_band(item, band);
    for (auto row = static_cast<std::size_t>(rows.first); row < static_cast<std::size_t>(rows.last); ++row) {
      const Range columns = columns_of_disc(static_cast<std::size_t>(item.index), row);
      std::int32_t* const link = &next[(row - band * band_rows) * stride];
      double* const line = radii + (row - band * band_rows) * width;
      const auto free_from = [link](std::int32_t column) {
        while (link[column] != column) column = link[column] = link[link[column]];
        return column;
      };
      for (std::int32_t x = columns.is_empty() ? columns.last : free_from(columns.first); x < columns.last;
           x = free_from(x)) {
        line[x] = item.radius;
        link[x] = x + 1;
      }
    }
  });
}

void Raster::draw_crescents(const Bands& crescents, std::size_t band, double* radii) const {
  crescents.in_band(band, [&](const Item& item) {
    const CoveringArc arc(skeleton_, static_cast<std::size_t>(item.index), slack_);
    const Crescent crescent = arc.crescent(margin_);
    const Range rows = rows_in_band(item, band);
    for (auto row = static_cast<std::size_t>(rows.first); row < static_cast<std::size_t>(rows.last); ++row) {
      const Range columns = columns_in(crescent.columns(row_y(row)));
      double* const line = radii + (row - band * band_rows) * pixels_.width;
      for (std::int32_t x = columns.first; x < columns.last; ++x) {
        if (line[x] >= item.radius) continue;
        line[x] = std::max(line[x], arc.radius_over(pixels_.place(static_cast<std::size_t>(x), row)));
      }
    }
  });
}

}  // namespace

void local_thickness(const SkeletonView& skeleton, const PixelCenters& pixels, double slack,
                     std::span<double> diameters, unsigned threads, const base::Monitor& monitor) {
  const Raster raster(skeleton, pixels, slack);
  const std::size_t bands = base::piece_count(pixels.height, band_rows);
  const Bands summits(raster.summits(), bands);
  const Bands crescents(raster.crescents(threads, monitor), bands);
  base::for_pieces(pixels.height, band_rows, threads, monitor,
                   [&](std::size_t band, std::size_t begin, std::size_t end) {
                     double* const rows = diameters.data() + begin * pixels.width;
                     double* const last = diameters.data() + end * pixels.width;
                     std::fill(rows, last, 0.0);
                     raster.draw_discs(summits, band, rows);
                     raster.draw_crescents(crescents, band, rows);
                     for (double* at = rows; at < last; ++at) *at *= 2;
                   });
}

}  // namespace vorotool::core::thickness
