#include "core/volumes/slab_scan.hpp"

#include <algorithm>

namespace vorotool::core::volumes {

using label_images::border_key;
using label_images::no_component;

SlabScan::SlabScan(std::size_t width, std::size_t height, std::size_t first)
    : labels{0},
      regions(1),
      width_(width),
      height_(height),
      z_(static_cast<std::uint32_t>(first)),
      starts_(width) {}

template <class Label>
void SlabScan::add_slice(std::span<const Label> slice, tessellation::Watch& watch) {
  slice_.runs.clear();
  slice_.rows.clear();
  for (std::size_t y = 0; y < height_; ++y) {
    watch.after_row(static_cast<std::int32_t>(y));
    const std::span<Run> row = cut(slice.subspan(y * width_, width_));
    contacts_.clear();
    boundaries_.assign(row.size(), {unknown, {0, 0}});
    if (y > 0) join_row<1>(slice_.row(y - 1), row);
    if (!last_slice.empty()) join_row<2>(last_slice.row(y), row);
    open_components(row);
    count_faces(row);
    measure(row, static_cast<std::uint32_t>(y));
    std::swap(boundaries_, last_boundaries_);
  }
  if (first_slice.empty()) first_slice = slice_;
  std::swap(last_slice, slice_);
  ++z_;
}

template <class Label>
std::span<SlabScan::Run> SlabScan::cut(std::span<const Label> row) {
  const std::size_t count = starts_.cut(row);
  const std::size_t begin = slice_.runs.size();
  slice_.rows.push_back(begin);
  slice_.runs.resize(begin + count + 1);
  const std::span<Run> runs = std::span(slice_.runs).subspan(begin);
  for (std::size_t k = 0; k < count; ++k) runs[k] = {starts_[k], row[starts_[k]], 0, no_component};
  runs[count] = {starts_[count], 0, 0, no_component};
  return runs;
}

// A row and its neighbor across an axis. The boundaries kept are those of the row above, which is that of the slice
// before where a slice has one row.
template <std::size_t Axis>
void SlabScan::join_row(std::span<const Run> other, std::span<Run> row) {
  const std::size_t last = row.size() - 2;
  for_overlaps(other, row, [&](std::size_t i, std::size_t j, std::uint32_t length) {
    const Run& one = other[i];
    if (one.label == row[j].label) {
      if (one.label != 0) join(one, row[j]);
      if ((Axis == 1 || height_ == 1) && i > 0 && j > 0 && other[i - 1].label == row[j - 1].label)
        boundaries_[j].interface = last_boundaries_[i].interface;
    } else if (const bool right = (j < last) & (one.label == row[j + 1].label);
               right | ((j > 0) & (one.label == row[j - (j > 0)].label))) {  // which one is unpredictable
      boundaries_[j + right].faces[Axis - 1] += length;
    } else {
      contacts_.push_back({&one, &row[j], length, Axis});
    }
  });
}

// The same label on both sides of a face.
void SlabScan::join(const Run& other, Run& run) {
  if (run.component == no_component) {
    run.region = other.region;
    run.component = other.component;
  } else if (run.component != other.component) {
    if (components.unite(run.component, other.component)) --regions[run.region].components;
    run.component = components.find(run.component);
  }
}

// A run that continues nothing starts a component; only here is a label looked up.
void SlabScan::open_components(std::span<Run> row) {
  for (Run& run : row.first(row.size() - 1)) {
    if (run.label == 0 || run.component != no_component) continue;
    std::uint64_t& number = numbers_[run.label];
    if (number == 0) {
      number = labels.size();
      labels.push_back(run.label);
      regions.emplace_back();
    }
    run.region = static_cast<std::uint32_t>(number);
    run.component = components.add();
    ++regions[run.region].components;
  }
}

void SlabScan::count_faces(std::span<const Run> row) {
  for (std::size_t k = 1; k + 1 < row.size(); ++k) {
    Boundary& boundary = boundaries_[k];
    if (boundary.interface == unknown) boundary.interface = interface_of(row[k - 1], row[k]);
    PerAxis& faces = interfaces[boundary.interface].faces;
    faces[0] += 1;
    faces[1] += boundary.faces[0];
    faces[2] += boundary.faces[1];
  }
  for (const Contact& contact : contacts_)
    interfaces[interface_of(*contact.one, *contact.other)].faces[contact.axis] += contact.length;
}

std::uint32_t SlabScan::interface_of(const Run& one, const Run& other) {
  std::uint64_t& number = pairs_[border_key(one.region, other.region)];
  if (number == 0) {
    interfaces.push_back({one.region, other.region, {}});
    number = interfaces.size();
  }
  return static_cast<std::uint32_t>(number - 1);
}

void SlabScan::measure(std::span<const Run> row, std::uint32_t y) {
  const std::int64_t outer_rows = (y == 0) + (y + 1 == height_);
  const std::int64_t outer_slices = z_ == 0;
  for (std::size_t k = 0; k + 1 < row.size(); ++k) {
    if (row[k].label == 0) continue;
    const std::int64_t start = row[k].start;
    const std::int64_t end = row[k + 1].start;
    const std::int64_t length = end - start;
    VolumeRegion& region = regions[row[k].region];
    region.voxels += length;
    region.faces[0] += (start == 0) + (row[k + 1].start == width_);
    region.faces[1] += outer_rows * length;
    region.faces[2] += outer_slices * length;
    region.sum[0] += (start + end - 1) * length / 2;  // one of the factors is even
    region.sum[1] += y * length;
    region.sum[2] += z_ * length;
    region.low = {std::min(region.low[0], row[k].start), std::min(region.low[1], y),
                  std::min(region.low[2], z_)};
    region.high = {std::max(region.high[0], row[k + 1].start - 1), std::max(region.high[1], y), z_};
  }
}

template void SlabScan::add_slice(std::span<const std::uint8_t>, tessellation::Watch&);
template void SlabScan::add_slice(std::span<const std::uint16_t>, tessellation::Watch&);
template void SlabScan::add_slice(std::span<const std::uint32_t>, tessellation::Watch&);

}  // namespace vorotool::core::volumes
