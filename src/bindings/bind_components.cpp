// Connected components, of masks held in memory and of masks that pass by.
#include <stdexcept>

#include "arrays.hpp"
#include "bindings.hpp"
#include "core/label_images/connected_components.hpp"
#include "core/label_images/streaming_components.hpp"
#include "interrupts.hpp"

namespace vorotool::bindings {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using core::base::Monitor;
using core::label_images::Connectivity;
using core::label_images::StreamingComponents;

Connectivity connectivity_of(bool corners) { return corners ? Connectivity::eight : Connectivity::four; }

// The kernels trust what is given to them.
void require(bool fits) {
  if (!fits) throw std::invalid_argument("the arrays do not fit together");
}

std::uint32_t label_components(Matrix<const std::uint8_t> mask, bool corners, Matrix<std::uint32_t> out,
                               nb::object progress) {
  return run_interruptible(progress, [&](const Monitor& monitor) {
    return core::label_images::label_components(view(mask), mask.shape(1), connectivity_of(corners),
                                                view(out), monitor);
  });
}

void add(StreamingComponents& components, Matrix<const std::uint8_t> mask, Matrix<std::uint32_t> out,
         nb::object progress) {
  require(mask.shape(1) == components.width() && mask.size() == out.size());
  run_interruptible(progress,
                    [&](const Monitor& monitor) { components.add(view(mask), view(out), monitor); });
}

std::uint32_t settle(StreamingComponents& components, Vector<std::uint32_t> out) {
  require(out.size() == std::size_t{components.size()} + 1);
  const nb::gil_scoped_release no_gil;
  return components.settle(view(out));
}

void number_band(Matrix<const std::uint8_t> mask, bool corners, Vector<const std::uint32_t> above,
                 Vector<const std::uint32_t> fresh, Matrix<std::uint32_t> out, nb::object progress) {
  require(mask.shape(1) == above.size() && mask.size() == out.size());
  run_interruptible(progress, [&](const Monitor& monitor) {
    core::label_images::number_band(view(mask), connectivity_of(corners), view(above), view(fresh), view(out),
                                    monitor);
  });
}

}  // namespace

void bind_components(nb::module_& module) {
  module.def("label_components", &label_components, "mask"_a.noconvert(), "corners"_a, "out"_a.noconvert(),
             "progress"_a.none());
  nb::class_<StreamingComponents>(module, "StreamingComponents")
      .def("__init__", [](StreamingComponents* self, std::size_t width,
                          bool corners) { new (self) StreamingComponents(width, connectivity_of(corners)); })
      .def_prop_ro("size", &StreamingComponents::size)
      .def("add", &add, "mask"_a.noconvert(), "out"_a.noconvert(), "progress"_a.none())
      .def("settle", &settle, "out"_a.noconvert());
  module.def("number_band", &number_band, "mask"_a.noconvert(), "corners"_a, "above"_a.noconvert(),
             "fresh"_a.noconvert(), "out"_a.noconvert(), "progress"_a.none());
}

}  // namespace vorotool::bindings
