// The tessellation of volumes, and the components of their masks.
#include <nanobind/stl/string_view.h>

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/simd.hpp"
#include "core/volumes/volume_components.hpp"
#include "core/volumes/volume_tessellation.hpp"

namespace vorotool::bindings {
namespace {

using core::base::Monitor;
using core::volumes::VolumeComponents;
using core::volumes::VolumeFrame;
using core::volumes::VolumeTessellation;
using core::volumes::Way;
using Integers = Vector<const std::int64_t>;
using Labels = Vector<const std::uint32_t>;
using Volume = Aligned<nb::ndim<3>, nb::c_contig, nb::device::cpu>;
template <class T>
using Slices = Aligned<T, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
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

}  // namespace

void bind_volumes(nb::module_& room) {
  nb::class_<VolumeTessellation>(room, "VolumeTessellation")
      .def(
          "__init__",
          [](VolumeTessellation* self, const Integers& x, const Integers& y, const Integers& z,
             const Labels& labels, const Origin& origin, const Size& size, std::int32_t scale,
             const Size& unit, std::string_view simd, std::string_view way) {
            const VolumeFrame frame = make_frame(origin, size, scale, unit);
            const auto level = simd_level(simd);
            const nb::gil_scoped_release no_gil;
            new (self) VolumeTessellation(view(x), view(y), view(z), view(labels), frame, level, way_of(way));
          },
          "x"_a, "y"_a, "z"_a, "labels"_a, "origin"_a, "size"_a, "scale"_a, "unit"_a, "simd"_a,
          "way"_a = "quicker")
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
  bind_volume_regions(room);
}

}  // namespace vorotool::bindings
