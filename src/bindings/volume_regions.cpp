// Measures, diagrams and the check of label volumes.
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/volumes/measure_volume.hpp"
#include "core/volumes/verify_volume.hpp"
#include "core/volumes/volume_diagram.hpp"

namespace vorotool::bindings {
namespace {

using core::base::Monitor;
using core::volumes::Interface;
using core::volumes::VolumeMeasurer;
using core::volumes::VolumeRegion;
using core::volumes::WrongVoxels;
using Integers = Vector<const std::int64_t>;
using Triple = std::tuple<std::int64_t, std::int64_t, std::int64_t>;
template <class T>
using Slices = Aligned<T, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
template <class T>
using Slice = std::optional<Matrix<const T>>;

std::array<std::int64_t, 3> by_axis(const Triple& given) {
  return {std::get<0>(given), std::get<1>(given), std::get<2>(given)};
}

template <class Label>
void add(VolumeMeasurer& measurer, const Slices<const Label>& labels, unsigned threads,
         const Progress& progress) {
  if (labels.shape(1) != measurer.height() || labels.shape(2) != measurer.width())
    throw std::invalid_argument("the slices differ in size");
  run_interruptible(progress, [&](const Monitor& monitor) { measurer.add(view(labels), threads, monitor); });
}

// An (n, 3) array: x, y, z.
template <class T, class Items, class Field>
Array<T> triples(const Items& items, Field field) {
  std::vector<T> values;
  values.reserve(3 * items.size());
  for (const auto& item : items) {
    for (const auto value : field(item)) values.push_back(static_cast<T>(value));
  }
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  T* data = kept->data();
  return owned(std::move(kept), data, {items.size(), 3});
}

Columns finish(VolumeMeasurer& measurer, const Progress& progress) {
  core::volumes::VolumeRegions found =
      run_interruptible(progress, [&](const Monitor& monitor) { return measurer.finish(monitor); });
  const auto& regions = found.regions;
  const auto& interfaces = found.interfaces;
  Columns columns;
  columns["voxels"] = column<std::int64_t>(regions, [](const VolumeRegion& r) { return r.voxels; });
  columns["components"] = column<std::int64_t>(regions, [](const VolumeRegion& r) { return r.components; });
  columns["faces"] = triples<std::int64_t>(regions, [](const VolumeRegion& r) { return r.faces; });
  columns["sums"] = triples<std::int64_t>(regions, [](const VolumeRegion& r) { return r.sum; });
  columns["low"] = triples<std::int64_t>(regions, [](const VolumeRegion& r) { return r.low; });
  columns["high"] = triples<std::int64_t>(regions, [](const VolumeRegion& r) { return r.high; });
  columns["border_a"] = column<std::uint32_t>(interfaces, [](const Interface& i) { return i.a; });
  columns["border_b"] = column<std::uint32_t>(interfaces, [](const Interface& i) { return i.b; });
  columns["border_faces"] = triples<std::int64_t>(interfaces, [](const Interface& i) { return i.faces; });
  columns["labels"] = to_numpy(std::move(found.labels));
  return columns;
}

template <class Label>
void mark_diagram(const Slices<const Label>& labels, const Slice<Label>& before, const Slice<Label>& after,
                  const Slices<std::uint8_t>& out, unsigned threads, const Progress& progress) {
  auto slice = [](const Slice<Label>& given) { return given ? view(*given) : std::span<const Label>(); };
  run_interruptible(progress, core::volumes::mark_diagram<Label>, view(labels), labels.shape(2),
                    labels.shape(1), slice(before), slice(after), view(out), threads);
}

template <class Label>
WrongVoxels verify_volume(const Slices<const Label>& labels, const Triple& origin, const Integers& x,
                          const Integers& y, const Integers& z,
                          const Vector<const std::uint32_t>& seed_labels, const Triple& side,
                          std::optional<std::uint64_t> limit_high, std::uint64_t limit_low, unsigned threads,
                          const Progress& progress) {
  for (const Integers& axis : {x, y, z}) {
    if (axis.size() != seed_labels.size()) throw std::invalid_argument("each seed must have one label");
  }
  const auto sides = by_axis(side);
  if (*std::min_element(sides.begin(), sides.end()) < 1)
    throw std::invalid_argument("the sides of a voxel must be at least 1 step");
  const core::volumes::VoxelsOnLattice voxels{
      by_axis(origin), {labels.shape(2), labels.shape(1), labels.shape(0)}, sides};
  const core::volumes::LatticeVolumeSeeds seeds{{view(x), view(y), view(z)}, view(seed_labels)};
  std::optional<core::numbers::uint128> limit;
  if (limit_high) limit = core::numbers::uint128{*limit_high} << 64 | limit_low;
  return run_interruptible(progress, core::volumes::verify_volume<Label>, view(labels), voxels, seeds, limit,
                           threads);
}

template <class Label>
void bind_labels(nb::module_& room, nb::class_<VolumeMeasurer>& measurer) {
  measurer.def("add", &add<Label>, "slices"_a, "threads"_a, "progress"_a.none());
  room.def("mark_diagram", &mark_diagram<Label>, "labels"_a, "before"_a.none(), "after"_a.none(), "out"_a,
           "threads"_a, "progress"_a.none());
  room.def("verify_volume", &verify_volume<Label>, "labels"_a, "origin"_a, "seed_x"_a, "seed_y"_a, "seed_z"_a,
           "seed_labels"_a, "side"_a, "limit_high"_a.none(), "limit_low"_a, "threads"_a, "progress"_a.none());
}

}  // namespace

void bind_volume_regions(nb::module_& room) {
  nb::class_<WrongVoxels>(room, "WrongVoxels", "Their number, and the first: its place, and its right label.")
      .def_ro("count", &WrongVoxels::count)
      .def_prop_ro("first",
                   [](const WrongVoxels& wrong) {
                     return std::make_tuple(wrong.first[0], wrong.first[1], wrong.first[2]);
                   })
      .def_ro("right", &WrongVoxels::right);
  nb::class_<VolumeMeasurer> measurer(room, "VolumeMeasurer", "Of slices in their order.");
  measurer.def(nb::init<std::size_t, std::size_t>(), "width"_a, "height"_a)
      .def("finish", &finish, "progress"_a.none());
  bind_labels<std::uint8_t>(room, measurer);
  bind_labels<std::uint16_t>(room, measurer);
  bind_labels<std::uint32_t>(room, measurer);
}

}  // namespace vorotool::bindings
