// Outlines of the objects of label images.
#include <nanobind/stl/string.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "core/base/parallel.hpp"
#include "core/label_images/crack_outlines.hpp"
#include "interrupts.hpp"

namespace vorotool::bindings {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using core::base::Monitor;

template <class Label>
std::size_t count_crack_vertices(const Matrix<const Label>& labels, unsigned threads, nb::object progress) {
  return run_interruptible(progress, [&](const Monitor& monitor) {
    return core::label_images::count_crack_vertices<Label>(view(labels), labels.shape(1),
                                                           core::base::resolve_threads(threads), monitor);
  });
}

core::label_images::CornerRule corner_rule(const std::string& name) {
  if (name == "apart") return core::label_images::CornerRule::apart;
  if (name == "divided") return core::label_images::CornerRule::divided;
  if (name == "joined") return core::label_images::CornerRule::joined;
  if (name == "yielding") return core::label_images::CornerRule::yielding;
  throw std::invalid_argument("a corner rule is apart, divided, joined or yielding");
}

template <class Label>
nb::dict trace_cracks(const Matrix<const Label>& labels, const std::string& rule, unsigned threads,
                      nb::object progress) {
  core::label_images::CrackOutlines made = run_interruptible(progress, [&](const Monitor& monitor) {
    return core::label_images::trace_cracks<Label>(view(labels), labels.shape(1), corner_rule(rule),
                                                   core::base::resolve_threads(threads), monitor);
  });
  nb::dict result;
  result["corners"] = two_columns(std::move(made.corners));
  result["start"] = to_numpy(std::move(made.start));
  result["is_hole"] = to_numpy(std::move(made.is_hole));
  result["ring_object"] = to_numpy(std::move(made.ring_object));
  result["labels"] = to_numpy(std::move(made.labels));
  return result;
}

template <class Label>
void bind_label_image(nb::module_& module) {
  module.def("count_crack_vertices", &count_crack_vertices<Label>, "labels"_a.noconvert(), "threads"_a,
             "progress"_a.none());
  module.def("trace_cracks", &trace_cracks<Label>, "labels"_a.noconvert(), "rule"_a, "threads"_a,
             "progress"_a.none());
}

}  // namespace

void bind_outlines(nb::module_& module) {
  bind_label_image<std::uint8_t>(module);
  bind_label_image<std::uint16_t>(module);
  bind_label_image<std::uint32_t>(module);
}

}  // namespace vorotool::bindings
