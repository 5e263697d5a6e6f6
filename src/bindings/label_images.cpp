// Measures, diagrams, outlines and connected components of label images and masks.
#include <optional>
#include <stdexcept>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/base/parallel.hpp"
#include "core/label_images/connected_components.hpp"
#include "core/label_images/crack_outlines.hpp"
#include "core/label_images/digital_diagram.hpp"
#include "core/label_images/region_measures.hpp"
#include "core/label_images/streaming_components.hpp"

namespace vorotool::bindings {
namespace {

using core::base::Monitor;
using core::label_images::Border;
using core::label_images::Connectivity;
using core::label_images::CornerRule;
using core::label_images::Region;
using core::label_images::StreamingComponents;

Columns regions_to_dict(core::label_images::Regions&& found) {
  Columns columns;
  auto put = [&](const char* name, auto field) {
    columns[name] = column<std::int64_t>(found.regions, field);
  };
  put("area", [](const Region& r) { return r.area; });
  put("perimeter", [](const Region& r) { return r.perimeter; });
  put("vertical_sides", [](const Region& r) { return r.vertical; });
  put("components", [](const Region& r) { return r.components; });
  put("sum_x", [](const Region& r) { return r.sum_x; });
  put("sum_y", [](const Region& r) { return r.sum_y; });
  put("left", [](const Region& r) { return r.left; });
  put("right", [](const Region& r) { return r.right; });
  put("top", [](const Region& r) { return r.top; });
  put("bottom", [](const Region& r) { return r.bottom; });
  columns["border_a"] = column<std::uint32_t>(found.borders, [](const Border& b) { return b.a; });
  columns["border_b"] = column<std::uint32_t>(found.borders, [](const Border& b) { return b.b; });
  columns["border_length"] = column<std::int64_t>(found.borders, [](const Border& b) { return b.length; });
  columns["border_vertical"] =
      column<std::int64_t>(found.borders, [](const Border& b) { return b.vertical; });
  columns["labels"] = to_numpy(std::move(found.labels));
  return columns;
}

template <class Label>
Columns measure_regions(Matrix<const Label> labels, unsigned threads, const Progress& progress) {
  return regions_to_dict(run_interruptible(progress, core::label_images::measure_regions<Label>, view(labels),
                                           labels.shape(1), labels.shape(0), threads));
}

template <class Label, class Value>
auto max_by_label(Matrix<const Label> labels, Matrix<const Value> values, Vector<const std::uint32_t> wanted,
                  unsigned threads, const Progress& progress) {
  return to_numpy(run_interruptible(progress, core::label_images::max_by_label<Label, Value>, view(labels),
                                    view(values), labels.shape(1), view(wanted), threads));
}

template <class Label>
void mark_diagram(Matrix<const Label> labels, std::optional<Vector<const Label>> above,
                  std::optional<Vector<const Label>> below, Matrix<std::uint8_t> out, unsigned threads,
                  const Progress& progress) {
  auto row = [](const std::optional<Vector<const Label>>& given) {
    return given ? view(*given) : std::span<const Label>();
  };
  run_interruptible(progress, core::label_images::mark_diagram<Label>, view(labels), labels.shape(1),
                    row(above), row(below), view(out), threads);
}

template <class Label>
std::size_t count_crack_vertices(const Matrix<const Label>& labels, unsigned threads,
                                 const Progress& progress) {
  return run_interruptible(progress, core::label_images::count_crack_vertices<Label>, view(labels),
                           labels.shape(1), core::base::resolve_threads(threads));
}

template <class Label>
Columns trace_cracks(const Matrix<const Label>& labels, CornerRule rule, unsigned threads,
                     const Progress& progress) {
  core::label_images::CrackOutlines made =
      run_interruptible(progress, core::label_images::trace_cracks<Label>, view(labels), labels.shape(1),
                        rule, core::base::resolve_threads(threads));
  Columns result;
  result["corners"] = two_columns(std::move(made.corners));
  result["start"] = to_numpy(std::move(made.start));
  result["is_hole"] = to_numpy(std::move(made.is_hole));
  result["ring_object"] = to_numpy(std::move(made.ring_object));
  result["labels"] = to_numpy(std::move(made.labels));
  return result;
}

Connectivity connectivity_of(bool corners) { return corners ? Connectivity::eight : Connectivity::four; }

// The kernels trust what is given to them.
void require(bool fits) {
  if (!fits) throw std::invalid_argument("the arrays do not fit together");
}

std::uint32_t label_components(Matrix<const std::uint8_t> mask, bool corners, Matrix<std::uint32_t> out,
                               const Progress& progress) {
  return run_interruptible(progress, core::label_images::label_components, view(mask), mask.shape(1),
                           connectivity_of(corners), view(out));
}

void add(StreamingComponents& components, Matrix<const std::uint8_t> mask, Matrix<std::uint32_t> out,
         const Progress& progress) {
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
                 Vector<const std::uint32_t> fresh, Matrix<std::uint32_t> out, const Progress& progress) {
  require(mask.shape(1) == above.size() && mask.size() == out.size());
  run_interruptible(progress, core::label_images::number_band, view(mask), connectivity_of(corners),
                    view(above), view(fresh), view(out));
}

template <class Label>
void bind_label_image(nb::module_& room) {
  room.def("measure_regions", &measure_regions<Label>, "labels"_a, "threads"_a, "progress"_a.none());
  room.def("max_by_label", &max_by_label<Label, std::uint32_t>, "labels"_a, "values"_a, "wanted"_a,
           "threads"_a, "progress"_a.none());
  room.def("max_by_label", &max_by_label<Label, std::uint64_t>, "labels"_a, "values"_a, "wanted"_a,
           "threads"_a, "progress"_a.none());
  room.def("mark_diagram", &mark_diagram<Label>, "labels"_a, "above"_a.none(), "below"_a.none(), "out"_a,
           "threads"_a, "progress"_a.none());
  room.def("count_crack_vertices", &count_crack_vertices<Label>, "labels"_a, "threads"_a,
           "progress"_a.none());
  room.def("trace_cracks", &trace_cracks<Label>, "labels"_a, "rule"_a, "threads"_a, "progress"_a.none());
}

}  // namespace

void bind_label_images(nb::module_& room) {
  nb::enum_<CornerRule>(room, "CornerRule")
      .value("apart", CornerRule::apart)
      .value("divided", CornerRule::divided)
      .value("joined", CornerRule::joined)
      .value("yielding", CornerRule::yielding);
  bind_label_image<std::uint8_t>(room);
  bind_label_image<std::uint16_t>(room);
  bind_label_image<std::uint32_t>(room);
  room.def("label_components", &label_components, "mask"_a, "corners"_a, "out"_a, "progress"_a.none(),
           "Of a mask of zeros and ones; the number of components.");
  nb::class_<StreamingComponents>(room, "StreamingComponents")
      .def(
          "__init__",
          [](StreamingComponents* self, std::size_t width, bool corners) {
            new (self) StreamingComponents(width, connectivity_of(corners));
          },
          "width"_a, "corners"_a)
      .def_prop_ro("size", &StreamingComponents::size)
      .def("add", &add, "mask"_a, "out"_a, "progress"_a.none())
      .def("settle", &settle, "out"_a);
  room.def("number_band", &number_band, "mask"_a, "corners"_a, "above"_a, "fresh"_a, "out"_a,
           "progress"_a.none());
}

}  // namespace vorotool::bindings
