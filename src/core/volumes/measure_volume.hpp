// Regions of a label volume (section 2.1, with one more axis): their measures, and which are neighbors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"

namespace vorotool::core::volumes {

using PerAxis = std::array<std::int64_t, 3>;  // x, y, z

// All voxels of one label, connected or not. Columns, rows and slices are counted from the corner of the volume.
struct VolumeRegion {
  std::int64_t voxels = 0;
  // Faces of voxels across each axis between the region and anything else, the outside of the volume included
  PerAxis faces{};
  std::int64_t components = 0;  // 6-connected parts
  PerAxis sum{};                // over the voxels; below 2^63 while voxels times a side are
  std::array<std::uint32_t, 3> low{UINT32_MAX, UINT32_MAX, UINT32_MAX};  // bounding box, both ends inside
  std::array<std::uint32_t, 3> high{};
};

// Two regions that share at least one face.
struct Interface {
  std::uint32_t a;  // indices of the regions, a < b
  std::uint32_t b;
  PerAxis faces;  // in common, across each axis
};

struct VolumeRegions {
  std::vector<std::uint32_t> labels;  // increasing; label 0 is background and no region
  std::vector<VolumeRegion> regions;  // one a label
  std::vector<Interface> interfaces;  // increasing by (a, b), each pair once
};

class SlabJoiner;

// Measures the regions of a volume, one pass over its runs, slab by slab. Working memory: the regions and the
// interfaces, and for each thread the runs of a few slices. The result depends neither on threads nor on slabs.
class VolumeMeasurer {
 public:
  // Throws std::length_error when a side has more than 2^32 - 2 voxels.
  VolumeMeasurer(std::size_t width, std::size_t height);
  ~VolumeMeasurer();

  std::size_t width() const { return width_; }
  std::size_t height() const { return height_; }

  // The next slices, row-major; labels of uint8_t, uint16_t or uint32_t. Threads share whole slices. What throws,
  // as an interrupt does, leaves a measurer that is of no further use.
  template <class Label>
  void add(std::span<const Label> slices, unsigned threads, const base::Monitor& monitor);

  // Once, after the last slices.
  VolumeRegions finish(const base::Monitor& monitor);

 private:
  std::size_t width_, height_;
  std::size_t depth_ = 0;  // so far
  std::unique_ptr<SlabJoiner> joiner_;
};

}  // namespace vorotool::core::volumes
