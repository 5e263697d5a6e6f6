// Volumes: their tessellation, the components of their masks, and measures, diagrams and the check of their labels.
#include <nanobind/stl/string_view.h>

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
#include "bindings/support/simd.hpp"
#include "core/volumes/measure_volume.hpp"
#include "core/volumes/verify_volume.hpp"
#include "core/volumes/volume_components.hpp"
#include "core/volumes/volume_diagram.hpp"
#include "core/volumes/volume_tessellation.hpp"

namespace vorotool::bindings {
namespace {

using core::base::Monitor;
using core::volumes::Interface;
using core::volumes::VolumeComponents;
using core::volumes::VolumeFrame;
using core::volumes::VolumeMeasurer;
using core::volumes::VolumeRegion;
using core::volumes::VolumeTessellation;
using core::volumes::Way;
using core::volumes::WrongVoxels;
using Integers = Vector<const std::int64_t>;
using Labels = Vector<const std::uint32_t>;
using Volume = Aligned<nb::ndim<3>, nb::c_contig, nb::device::cpu>;
template <class T>
using Slices = Aligned<T, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
template <class T>
using Slice = std::optional<Matrix<const T>>;
using Halves = std::pair<std::uint64_t, std::uint64_t>;  // upper and lower 64 bits
using Origin = std::tuple<std::int64_t, std::int64_t, std::int64_t>;
using Size = std::tuple<std::int32_t, std::int32_t, std::int32_t>;

// Twice the steps of a side fit 32 bits.
constexpr std::int32_t most_steps = std::int32_t{1} << 29;

// Origin, size and unit along x, y and z.
VolumeFrame make_frame(const Origin& origin, const Size& size, std::int32_t scale, const Size& unit) {
  const auto [x, y, z] = origin;
  const auto [width, height, depth] = size;
  const auto [unit_x, unit_y, unit_z] = unit;
  if (scale < 1 || std::min({unit_x, unit_y, unit_z}) < 1 ||
      std::max({unit_x, unit_y, unit_z}) > most_steps / scale) {
    throw std::invalid_argument("the sides of a voxel must be from 1 to 2^29 steps");
  }
  return {{x, y, width, height, scale, {unit_x, unit_y}}, z, depth, unit_z};
}

Way way_of(std::string_view name) {
  if (name == "quicker") return Way::quicker;
  if (name == "rows") return Way::rows;
  if (name == "bricks") return Way::bricks;
  throw std::invalid_argument("the way is quicker, rows or bricks");
}

// Slices of an output, checked against the frame.
std::int32_t slices_of(const VolumeTessellation& tessellation, const Volume& out, std::int32_t first) {
  const auto& frame = tessellation.frame();
  const auto slices = static_cast<std::int64_t>(out.shape(0));
  if (static_cast<std::int64_t>(out.shape(2)) != frame.plane.width ||
      static_cast<std::int64_t>(out.shape(1)) != frame.plane.height || first < 0 ||
      first + slices > frame.depth) {
    throw std::invalid_argument("the output does not fit the frame");
  }
  return static_cast<std::int32_t>(slices);
}

// Calls body(pointer) with the element type of `out`, one of Types.
template <class... Types, class Body>
void with_type(const Volume& out, Body body) {
  const bool known =
      ((out.dtype() == nb::dtype<Types>() && (body(static_cast<Types*>(out.data())), true)) || ...);
  if (!known) throw std::invalid_argument("the output has an element type that this function does not write");
}

void write_labels(const VolumeTessellation& tessellation, const Volume& out, std::int32_t first,
                  std::optional<Halves> most_squared, unsigned threads, const Progress& progress) {
  const std::int32_t slices = slices_of(tessellation, out, first);
  std::optional<core::numbers::uint128> limit;
  if (most_squared) limit = core::numbers::uint128{most_squared->first} << 64 | most_squared->second;
  with_type<std::uint8_t, std::uint16_t, std::uint32_t>(out, [&](auto* voxels) {
    run_interruptible(progress, [&](const Monitor& monitor) {
      tessellation.labels(first, slices, voxels, limit, threads, monitor);
    });
  });
}

void write_squared_distances(const VolumeTessellation& tessellation, const Volume& out, std::int32_t first,
                             unsigned threads, const Progress& progress) {
  const std::int32_t slices = slices_of(tessellation, out, first);
  with_type<std::uint32_t, std::uint64_t>(out, [&](auto* voxels) {
    run_interruptible(progress, [&](const Monitor& monitor) {
      tessellation.squared_distances(first, slices, voxels, threads, monitor);
    });
  });
}

void write_distances(const VolumeTessellation& tessellation, const Volume& out, std::int32_t first,
                     double square_of_step, unsigned threads, const Progress& progress) {
  const std::int32_t slices = slices_of(tessellation, out, first);
  with_type<float>(out, [&](float* voxels) {
    run_interruptible(progress, [&](const Monitor& monitor) {
      tessellation.distances(first, slices, voxels, square_of_step, threads, monitor);
    });
  });
}

void add_slices(VolumeComponents& components, const Slices<const std::uint8_t>& mask,
                const Slices<std::uint32_t>& out, const Progress& progress) {
  if (mask.shape(2) != components.width() || mask.shape(1) != components.height() ||
      mask.size() != out.size()) {
    throw std::invalid_argument("the slices do not fit the components");
  }
  run_interruptible(progress, [&](const Monitor& monitor) {
    components.add({mask.data(), mask.size()}, {out.data(), out.size()}, monitor);
  });
}

std::uint32_t settle(VolumeComponents& components, const Vector<std::uint32_t>& out) {
  if (out.size() != std::size_t{components.size()} + 1) {
    throw std::invalid_argument("the numbers do not fit the components");
  }
  const nb::gil_scoped_release no_gil;
  return components.settle(view(out));
}

std::array<std::int64_t, 3> by_axis(const Origin& given) {
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
WrongVoxels verify_volume(const Slices<const Label>& labels, const Origin& origin, const Integers& x,
                          const Integers& y, const Integers& z,
                          const Vector<const std::uint32_t>& seed_labels, const Origin& side,
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

void bind_volumes(nb::module_& room) {
  nb::class_<VolumeTessellation>(room, "VolumeTessellation")
      .def(
          "__init__",
          [](VolumeTessellation* self, const Integers& x, const Integers& y, const Integers& z,
             const Labels& labels, const Origin& origin, const Size& size, std::int32_t scale,
             const Size& unit, std::string_view simd, std::string_view way, unsigned threads) {
            const VolumeFrame frame = make_frame(origin, size, scale, unit);
            const auto level = simd_level(simd);
            const nb::gil_scoped_release no_gil;
            new (self) VolumeTessellation(view(x), view(y), view(z), view(labels), frame, level, way_of(way),
                                          threads);
          },
          "x"_a, "y"_a, "z"_a, "labels"_a, "origin"_a, "size"_a, "scale"_a, "unit"_a, "simd"_a,
          "way"_a = "quicker", "threads"_a = 1)
      .def_prop_ro("duplicates", &VolumeTessellation::duplicates)
      .def_prop_ro("is_wide", &VolumeTessellation::is_wide)
      .def_prop_ro("products_exact", &VolumeTessellation::products_exact)
      .def("labels", &write_labels, "out"_a, "first"_a, "most_squared"_a.none(), "threads"_a,
           "progress"_a.none())
      .def("squared_distances", &write_squared_distances, "out"_a, "first"_a, "threads"_a,
           "progress"_a.none())
      .def("distances", &write_distances, "out"_a, "first"_a, "square_of_step"_a, "threads"_a,
           "progress"_a.none());
  nb::class_<VolumeComponents>(room, "VolumeComponents")
      .def(
          "__init__",
          [](VolumeComponents* self, std::size_t width, std::size_t height, bool corners) {
            using core::volumes::Connectivity;
            new (self)
                VolumeComponents(width, height, corners ? Connectivity::twenty_six : Connectivity::six);
          },
          "width"_a, "height"_a, "corners"_a)
      .def_prop_ro("size", &VolumeComponents::size)
      .def("add", &add_slices, "mask"_a, "out"_a, "progress"_a.none())
      .def("settle", &settle, "out"_a);
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
