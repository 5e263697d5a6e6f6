// Regions of a label image (section 2.1): their measures, and which are neighbors.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"

namespace vorotool::core::label_images {

// All pixels of one label, connected or not. Columns and rows are counted from the corner of the image.
struct Region {
  std::int64_t area = 0;
  // Pixel sides between the region and anything else, the outside of the image included
  std::int64_t perimeter = 0;
  std::int64_t vertical = 0;    // of these, the left and right sides of pixels
  std::int64_t components = 0;  // 4-connected parts
  std::int64_t sum_x = 0;       // over the pixels; below 2^63 while pixels * width are
  std::int64_t sum_y = 0;
  std::uint32_t left = UINT32_MAX;  // bounding box, both ends inside
  std::uint32_t right = 0;
  std::uint32_t top = UINT32_MAX;
  std::uint32_t bottom = 0;
};

// Two regions that share at least one pixel side.
struct Border {
  std::uint32_t a;  // indices of the regions, a < b
  std::uint32_t b;
  std::int64_t length;    // pixel sides in common
  std::int64_t vertical;  // of these, left and right sides
};

struct Regions {
  std::vector<std::uint32_t> labels;  // increasing; label 0 is background and no region
  std::vector<Region> regions;        // one a label
  std::vector<Border> borders;        // increasing by (a, b), each pair once
};

// Measures the regions of a row-major image of width * height labels (uint8_t, uint16_t or uint32_t), one
// pass over its runs. Working memory: the runs of a few rows, and the regions, components and borders. The
// result does not depend on `threads`. Throws std::length_error when a side has more than 2^32 - 2 pixels.
template <class Label>
Regions measure_regions(std::span<const Label> image, std::size_t width, std::size_t height, unsigned threads,
                        const base::Monitor& monitor);

// The largest of `values` (uint32_t or uint64_t, one a pixel) over the pixels of each label in `labels`
// (increasing); 0 for a label without pixels. Labels of the image that are not in `labels` are passed over.
template <class Label, class Value>
std::vector<std::uint64_t> max_by_label(std::span<const Label> image, std::span<const Value> values,
                                        std::size_t width, std::span<const std::uint32_t> labels,
                                        unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::label_images
