// The tessellation of frames, and its check.
#include <nanobind/stl/string_view.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/simd.hpp"
#include "core/tessellation/propagation.hpp"
#include "core/tessellation/tessellation.hpp"
#include "core/tessellation/verify_tessellation.hpp"

namespace vorotool::bindings {
namespace {

using core::base::Monitor;
using core::tessellation::FrameOnLattice;
using core::tessellation::Simd;
using core::tessellation::Tessellation;
using Integers = Aligned<const std::int64_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Labels = Aligned<const std::uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Image = Aligned<nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Label32Image = Aligned<std::uint32_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Halves = std::pair<std::uint64_t, std::uint64_t>;  // upper and lower 64 bits
using Sides = std::pair<std::int64_t, std::int64_t>;     // of a pixel, along x and y

constexpr std::int64_t most_steps = core::tessellation::wide_bound;  // of a pixel

Tessellation make_tessellation(const Integers& x, const Integers& y, const Labels& labels,
                               std::int64_t frame_x, std::int64_t frame_y, std::int32_t width,
                               std::int32_t height, std::int64_t scale, const Sides& unit,
                               std::string_view simd) {
  const FrameOnLattice frame{frame_x, frame_y, width, height, scale, {unit.first, unit.second}};
  if (scale < 1 || std::min(unit.first, unit.second) < 1 ||
      std::max(unit.first, unit.second) > most_steps / scale) {
    throw std::invalid_argument("the sides of a pixel must be from 1 to 2^40 steps");
  }
  const Simd level = simd_level(simd);
  const nb::gil_scoped_release no_gil;
  return {view(x), view(y), view(labels), frame, level};
}

// Rows of an output image, checked against the frame.
std::int32_t rows_of(const Tessellation& tessellation, const Image& out, std::int32_t first) {
  const auto& frame = tessellation.frame();
  const auto rows = static_cast<std::int64_t>(out.shape(0));
  if (static_cast<std::int64_t>(out.shape(1)) != frame.width || first < 0 || first + rows > frame.height) {
    throw std::invalid_argument("the output does not fit the frame");
  }
  return static_cast<std::int32_t>(rows);
}

// Calls body(pointer) with the element type of `out`, one of Types.
template <class... Types, class Body>
void with_type(const Image& out, Body body) {
  const bool known =
      ((out.dtype() == nb::dtype<Types>() && (body(static_cast<Types*>(out.data())), true)) || ...);
  if (!known) throw std::invalid_argument("the output has an element type that this function does not write");
}

void write_labels(const Tessellation& tessellation, const Image& out, std::int32_t first,
                  std::optional<Halves> most_squared, unsigned threads, const Progress& progress) {
  const std::int32_t rows = rows_of(tessellation, out, first);
  std::optional<core::numbers::uint128> limit;
  if (most_squared) limit = core::numbers::uint128{most_squared->first} << 64 | most_squared->second;
  const auto write = [&](auto* pixels) {
    run_interruptible(progress, [&](const Monitor& monitor) {
      tessellation.labels(first, rows, pixels, limit, threads, monitor);
    });
  };
  if (out.dtype() == nb::dtype<std::int32_t>()) {  // labels are below 2^31: the bits are those of uint32
    write(static_cast<std::uint32_t*>(out.data()));
  } else {
    with_type<std::uint8_t, std::uint16_t, std::uint32_t>(out, write);
  }
}

void write_squared_distances(const Tessellation& tessellation, const Image& out, std::int32_t first,
                             unsigned threads, const Progress& progress) {
  const std::int32_t rows = rows_of(tessellation, out, first);
  with_type<std::uint32_t, std::uint64_t, double>(out, [&](auto* pixels) {
    run_interruptible(progress, [&](const Monitor& monitor) {
      tessellation.squared_distances(first, rows, pixels, threads, monitor);
    });
  });
}

void write_distances(const Tessellation& tessellation, const Image& out, std::int32_t first,
                     double square_of_step, unsigned threads, const Progress& progress) {
  const std::int32_t rows = rows_of(tessellation, out, first);
  with_type<float>(out, [&](float* pixels) {
    run_interruptible(progress, [&](const Monitor& monitor) {
      tessellation.distances(first, rows, pixels, square_of_step, threads, monitor);
    });
  });
}

void propagate(const Integers& x, const Integers& y, const Labels& labels, int passes,
               const Label32Image& out, const Progress& progress) {
  run_interruptible(progress, core::tessellation::propagate, view(x), view(y), view(labels),
                    static_cast<std::int32_t>(out.shape(1)), static_cast<std::int32_t>(out.shape(0)), passes,
                    out.data());
}

// `limit_high` and `limit_low` are the halves of a 128-bit limit of the squared distance.
template <class Label>
auto verify_tessellation(Matrix<const Label> labels, std::int64_t x, std::int64_t y,
                         Vector<const std::int64_t> seed_x, Vector<const std::int64_t> seed_y,
                         Vector<const std::uint32_t> seed_labels, const Sides& pixel,
                         std::optional<std::uint64_t> limit_high, std::uint64_t limit_low, unsigned threads,
                         const Progress& progress) {
  const core::tessellation::PixelFrame frame{x, y, labels.shape(1), labels.shape(0)};
  const core::tessellation::LatticeSeeds seeds{
      view(seed_x), view(seed_y), view(seed_labels), {pixel.first, pixel.second}};
  std::optional<core::numbers::uint128> limit;
  if (limit_high) limit = core::numbers::uint128{*limit_high} << 64 | limit_low;
  return run_interruptible(progress, core::tessellation::verify_tessellation<Label>, view(labels), frame,
                           seeds, limit, threads);
}

// core::SeedTooFar as SeedTooFarError(index).
void bind_seed_too_far(nb::module_& room) {
  PyObject* const type =
      PyErr_NewException("vorotool._core.tessellation.SeedTooFarError", PyExc_ValueError, nullptr);
  room.attr("SeedTooFarError") = nb::borrow(type);
  nb::register_exception_translator(
      [](const std::exception_ptr& failure, void* payload) {
        try {
          std::rethrow_exception(failure);
        } catch (const core::tessellation::SeedTooFar& e) {
          PyErr_SetObject(static_cast<PyObject*>(payload), nb::make_tuple(e.index).ptr());
        }
      },
      type);
}

template <class Label>
void bind_verification(nb::module_& room) {
  room.def("verify_tessellation", &verify_tessellation<Label>, "labels"_a, "x"_a, "y"_a, "seed_x"_a,
           "seed_y"_a, "seed_labels"_a, "pixel"_a, "limit_high"_a.none(), "limit_low"_a, "threads"_a,
           "progress"_a.none());
}

}  // namespace

void bind_tessellation(nb::module_& room) {
  bind_seed_too_far(room);
  nb::class_<Tessellation>(room, "Tessellation")
      .def(
          "__init__",
          [](Tessellation* self, const Integers& x, const Integers& y, const Labels& labels,
             std::int64_t frame_x, std::int64_t frame_y, std::int32_t width, std::int32_t height,
             std::int64_t scale, const Sides& unit, std::string_view simd) {
            new (self) Tessellation(
                make_tessellation(x, y, labels, frame_x, frame_y, width, height, scale, unit, simd));
          },
          "x"_a, "y"_a, "labels"_a, "frame_x"_a, "frame_y"_a, "width"_a, "height"_a, "scale"_a, "unit"_a,
          "simd"_a)
      .def_prop_ro("duplicates", &Tessellation::duplicates)
      .def_prop_ro("columns", &Tessellation::columns)
      .def_prop_ro("is_wide", &Tessellation::is_wide)
      .def_prop_ro("products_exact", &Tessellation::products_exact)
      .def("labels", &write_labels, "out"_a, "first"_a, "most_squared"_a.none(), "threads"_a,
           "progress"_a.none())
      .def("squared_distances", &write_squared_distances, "out"_a, "first"_a, "threads"_a,
           "progress"_a.none())
      .def("distances", &write_distances, "out"_a, "first"_a, "square_of_step"_a, "threads"_a,
           "progress"_a.none());
  room.def("propagate", &propagate, "x"_a, "y"_a, "labels"_a, "passes"_a, "out"_a, "progress"_a.none());
  room.def("widest_simd",
           [] { return std::string(core::tessellation::name_of(core::tessellation::widest_simd())); });
  using core::tessellation::WrongPixels;
  nb::class_<WrongPixels>(room, "WrongPixels", "Their number, and the first: its place, and its right label.")
      .def_ro("count", &WrongPixels::count)
      .def_ro("column", &WrongPixels::column)
      .def_ro("row", &WrongPixels::row)
      .def_ro("right", &WrongPixels::right);
  bind_verification<std::uint8_t>(room);
  bind_verification<std::uint16_t>(room);
  bind_verification<std::uint32_t>(room);
}

}  // namespace vorotool::bindings
