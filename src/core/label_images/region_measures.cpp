#include "core/label_images/region_measures.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <stdexcept>

#include "core/base/parallel.hpp"
#include "core/label_images/region_scan.hpp"

namespace vorotool::core::label_images {

using base::Monitor;
using base::parallel_for;

namespace {

template <class Label>
std::unique_ptr<BandScan> scan_band(std::span<const Label> image, std::size_t width, std::size_t first,
                                    std::size_t last) {
  auto band = std::make_unique<BandScan>(width, first);
  for (std::size_t y = first; y < last; ++y) band->add_row(image.subspan(y * width, width));
  return band;
}

std::vector<std::uint32_t> distinct_labels(std::span<const std::unique_ptr<BandScan>> bands) {
  std::vector<std::uint32_t> all;
  for (const auto& band : bands) all.insert(all.end(), band->labels.begin() + 1, band->labels.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void absorb(Region& into, const Region& part) {
  into.area += part.area;
  into.perimeter += part.perimeter;
  into.vertical += part.vertical;
  into.components += part.components;
  into.sum_x += part.sum_x;
  into.sum_y += part.sum_y;
  into.left = std::min(into.left, part.left);
  into.right = std::max(into.right, part.right);
  into.top = std::min(into.top, part.top);
  into.bottom = std::max(into.bottom, part.bottom);
}

// Joins bands from the top. Only sums, minima and maxima of integers: how the rows were cut leaves no trace.
class BandJoiner {
 public:
  BandJoiner(std::vector<std::uint32_t> labels, const Monitor& monitor) : monitor_(monitor) {
    result_.labels = std::move(labels);
    result_.regions.resize(result_.labels.size());
  }

  // `index` maps the band's region numbers to positions in labels.
  void add(BandScan& band, const std::vector<std::uint32_t>& index) {
    for (std::size_t r = 1; r < index.size(); ++r) absorb(result_.regions[index[r]], band.regions[r]);
    band.borders.for_each([&](std::uint64_t key, std::uint64_t sides) {
      put(index[key >> 32], index[key & UINT32_MAX], horizontal_sides(sides), vertical_sides(sides));
    });
    const std::uint32_t offset = components_.size();
    components_.append(band.components);
    renumber(band.first_runs, index, offset);
    renumber(band.last_runs, index, offset);
    if (!last_runs_.empty()) sew(last_runs_, band.first_runs);
    last_runs_ = std::move(band.last_runs);
  }

  std::span<const std::uint32_t> labels() const { return result_.labels; }

  Regions finish() {
    sort_borders();
    return std::move(result_);
  }

 private:
  static void renumber(RunRow& runs, const std::vector<std::uint32_t>& index, std::uint32_t offset) {
    for (Run& run : runs) {
      if (run.label == 0) continue;
      run.region = index[run.region];
      run.component += offset;
    }
  }

  // Called for the borders done, of which noise has millions.
  void poll(std::size_t steps = 1) {
    steps_ += steps;
    if (steps_ < (1U << 16)) return;
    steps_ = 0;
    base::report(monitor_, 1);
  }

  void put(std::uint32_t one, std::uint32_t other, std::int64_t horizontal, std::int64_t vertical) {
    poll();
    borders_.push_back({std::min(one, other), std::max(one, other), horizontal + vertical, vertical});
  }

  void sew(const RunRow& above, const RunRow& below) {
    find_overlaps(above, below, overlaps_);
    for (const Overlap& overlap : overlaps_) {
      const Run& one = above[overlap.above];
      const Run& other = below[overlap.below];
      if (one.label == 0 || other.label == 0) continue;
      if (one.label != other.label) {
        put(one.region, other.region, overlap.length, 0);
        continue;
      }
      Region& region = result_.regions[one.region];
      region.perimeter -= 2 * std::int64_t{overlap.length};
      if (components_.unite(one.component, other.component)) --region.components;
    }
  }

  // Buckets by a, then each bucket, which is short as a rule, by b; adds up pairs that several bands have.
  void sort_borders() {
    std::vector<std::size_t> start(result_.labels.size() + 2, 0);
    for (const Border& border : borders_) ++start[border.a + 2];
    for (std::size_t a = 2; a < start.size(); ++a) start[a] += start[a - 1];
    std::vector<Border> sorted(borders_.size());
    for (const Border& border : borders_) {
      poll();
      sorted[start[border.a + 1]++] = border;
    }
    auto by_b = [](const Border& p, const Border& q) { return p.b < q.b; };
    for (std::size_t a = 0; a < result_.labels.size(); ++a) {
      poll(start[a + 1] - start[a]);
      std::sort(sorted.data() + start[a], sorted.data() + start[a + 1], by_b);
    }
    for (const Border& border : sorted) {
      poll();
      auto& kept = result_.borders;
      if (!kept.empty() && kept.back().a == border.a && kept.back().b == border.b) {
        kept.back().length += border.length;
        kept.back().vertical += border.vertical;
      } else {
        kept.push_back(border);
      }
    }
  }

  const Monitor& monitor_;
  std::size_t steps_ = 0;  // since the monitor was asked
  Regions result_;
  std::vector<Border> borders_;  // in no order, a pair several times
  ComponentSets components_;
  RunRow last_runs_;
  std::vector<Overlap> overlaps_;
};

std::vector<std::uint32_t> positions(std::span<const std::uint32_t> labels, const BandScan& band) {
  std::vector<std::uint32_t> index(band.labels.size(), 0);
  for (std::size_t r = 1; r < index.size(); ++r) {
    const auto found = std::lower_bound(labels.begin(), labels.end(), band.labels[r]);
    index[r] = static_cast<std::uint32_t>(found - labels.begin());
  }
  return index;
}

}  // namespace

template <class Label>
Regions measure_regions(std::span<const Label> image, std::size_t width, std::size_t height, unsigned threads,
                        const Monitor& monitor) {
  if (std::max(width, height) >= UINT32_MAX) throw std::length_error("a side exceeds 2^32 - 2 pixels");
  if (image.empty()) return {};
  const std::size_t rows = rows_per_piece(width);
  std::vector<std::unique_ptr<BandScan>> bands(base::piece_count(height, rows));
  base::for_pieces(height, rows, threads, monitor, [&](std::size_t k, std::size_t begin, std::size_t end) {
    bands[k] = scan_band(image, width, begin, end);
  });

  BandJoiner joiner(distinct_labels(bands), monitor);
  std::vector<std::vector<std::uint32_t>> index(bands.size());
  parallel_for(
      bands.size(), threads, [&](std::size_t k) { index[k] = positions(joiner.labels(), *bands[k]); },
      monitor);
  for (std::size_t k = 0; k < bands.size(); ++k) {
    joiner.add(*bands[k], index[k]);
    bands[k].reset();
  }
  return joiner.finish();
}

template <class Label, class Value>
std::vector<std::uint64_t> max_by_label(std::span<const Label> image, std::span<const Value> values,
                                        std::size_t width, std::span<const std::uint32_t> labels,
                                        unsigned threads, const Monitor& monitor) {
  if (values.size() != image.size()) throw std::length_error("the values have another size than the labels");
  if (image.empty()) return std::vector<std::uint64_t>(labels.size(), 0);
  base::FlatMap numbers(labels.size());
  for (std::size_t k = 0; k < labels.size(); ++k) numbers[labels[k]] = k + 1;
  std::vector<std::atomic<std::uint64_t>> largest(labels.size());  // shared: a maximum knows no order
  const std::size_t height = image.size() / width;
  const auto scan = [&](std::size_t, std::size_t begin, std::size_t end) {
    RunStarts starts(width);
    for (std::size_t y = begin; y < end; ++y) {
      const auto row = image.subspan(y * width, width);
      const Value* value = values.data() + y * width;
      const std::size_t count = starts.cut(row);
      for (std::size_t k = 0; k < count; ++k) {
        const Label label = row[starts[k]];
        const std::uint64_t number = label == 0 ? 0 : numbers.find(label);
        if (number == 0) continue;
        const std::uint64_t found = *std::max_element(value + starts[k], value + starts[k + 1]);
        std::atomic<std::uint64_t>& best = largest[number - 1];
        std::uint64_t known = best.load(std::memory_order_relaxed);
        while (known < found && !best.compare_exchange_weak(known, found, std::memory_order_relaxed)) {
        }
      }
    }
  };
  base::for_pieces(height, rows_per_piece(width), threads, monitor, scan);
  return {largest.begin(), largest.end()};
}

#define VOROTOOL_INSTANTIATE(Label)                                                                        \
  template Regions measure_regions(std::span<const Label>, std::size_t, std::size_t, unsigned,             \
                                   const Monitor&);                                                        \
  template std::vector<std::uint64_t> max_by_label(std::span<const Label>, std::span<const std::uint32_t>, \
                                                   std::size_t, std::span<const std::uint32_t>, unsigned,  \
                                                   const Monitor&);                                        \
  template std::vector<std::uint64_t> max_by_label(std::span<const Label>, std::span<const std::uint64_t>, \
                                                   std::size_t, std::span<const std::uint32_t>, unsigned,  \
                                                   const Monitor&);
VOROTOOL_INSTANTIATE(std::uint8_t)
VOROTOOL_INSTANTIATE(std::uint16_t)
VOROTOOL_INSTANTIATE(std::uint32_t)
#undef VOROTOOL_INSTANTIATE

}  // namespace vorotool::core::label_images
