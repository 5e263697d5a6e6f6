// Measures, diagram, colouring and check of label images.
#include <nanobind/stl/optional.h>

#include <optional>

#include "arrays.hpp"
#include "bindings.hpp"
#include "core/graphs/graph_colouring.hpp"
#include "core/label_images/digital_diagram.hpp"
#include "core/label_images/region_measures.hpp"
#include "core/spatial/nearest_sites.hpp"
#include "core/tessellation/verify_tessellation.hpp"
#include "interrupts.hpp"

namespace vorotool::bindings {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using core::base::Monitor;
using core::label_images::Border;
using core::label_images::Region;
using core::spatial::NearestOther;

nb::dict regions_to_dict(core::label_images::Regions&& found) {
  nb::dict columns;
  auto put = [&](const char* name, auto field) {
    columns[name] = column<std::int64_t>(found.regions, field);
  };
  put("area", [](const Region& r) { return r.area; });
  put("perimeter", [](const Region& r) { return r.perimeter; });
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
  columns["labels"] = to_numpy(std::move(found.labels));
  return columns;
}

template <class Label>
nb::dict measure_regions(Matrix<const Label> labels, unsigned threads, nb::object progress) {
  return regions_to_dict(run_interruptible(progress, [&](const Monitor& monitor) {
    return core::label_images::measure_regions<Label>(view(labels), labels.shape(1), labels.shape(0), threads,
                                                      monitor);
  }));
}

template <class Label, class Value>
nb::object max_by_label(Matrix<const Label> labels, Matrix<const Value> values,
                        Vector<const std::uint32_t> wanted, unsigned threads, nb::object progress) {
  return to_numpy(run_interruptible(progress, [&](const Monitor& monitor) {
    return core::label_images::max_by_label<Label, Value>(view(labels), view(values), labels.shape(1),
                                                          view(wanted), threads, monitor);
  }));
}

template <class Label>
void mark_diagram(Matrix<const Label> labels, std::optional<Vector<const Label>> above,
                  std::optional<Vector<const Label>> below, Matrix<std::uint8_t> out, unsigned threads,
                  nb::object progress) {
  auto row = [](const std::optional<Vector<const Label>>& given) {
    return given ? view(*given) : std::span<const Label>();
  };
  run_interruptible(progress, [&](const Monitor& monitor) {
    core::label_images::mark_diagram<Label>(view(labels), labels.shape(1), row(above), row(below), view(out),
                                            threads, monitor);
  });
}

// `limit_high` and `limit_low` are the halves of a 128-bit limit of the squared distance.
template <class Label>
nb::tuple verify_tessellation(Matrix<const Label> labels, std::int64_t x, std::int64_t y,
                              Vector<const std::int64_t> seed_x, Vector<const std::int64_t> seed_y,
                              Vector<const std::uint32_t> seed_labels, std::int64_t scale,
                              std::optional<std::uint64_t> limit_high, std::uint64_t limit_low,
                              unsigned threads, nb::object progress) {
  const core::tessellation::PixelFrame frame{x, y, labels.shape(1), labels.shape(0)};
  const core::tessellation::LatticeSeeds seeds{view(seed_x), view(seed_y), view(seed_labels), scale};
  std::optional<core::numbers::uint128> limit;
  if (limit_high) limit = core::numbers::uint128{*limit_high} << 64 | limit_low;
  const core::tessellation::WrongPixels wrong = run_interruptible(progress, [&](const Monitor& monitor) {
    return core::tessellation::verify_tessellation<Label>(view(labels), frame, seeds, limit, threads,
                                                          monitor);
  });
  return nb::make_tuple(wrong.count, wrong.column, wrong.row, wrong.found, wrong.right);
}

nb::tuple nearest_other_sites(Vector<const double> x, Vector<const double> y,
                              Vector<const std::uint32_t> labels, unsigned threads, nb::object progress) {
  const auto found = run_interruptible(progress, [&](const Monitor& monitor) {
    return core::spatial::nearest_other_sites(view(x), view(y), view(labels), threads, monitor);
  });
  return nb::make_tuple(column<std::int64_t>(found, [](const NearestOther& n) { return n.index; }),
                        column<double>(found, [](const NearestOther& n) { return n.distance; }));
}

nb::object colour_graph(std::size_t vertices, Vector<const std::uint32_t> a, Vector<const std::uint32_t> b,
                        nb::object progress) {
  std::vector<core::graphs::Edge> edges(a.size());
  for (std::size_t k = 0; k < edges.size(); ++k) edges[k] = {a.data()[k], b.data()[k]};
  return to_numpy(run_interruptible(progress, [&](const Monitor& monitor) {
    return core::graphs::colour_graph(vertices, edges, monitor);
  }));
}

template <class Label>
void bind_label_image(nb::module_& module) {
  module.def("measure_regions", &measure_regions<Label>, "labels"_a.noconvert(), "threads"_a,
             "progress"_a.none());
  module.def("max_by_label", &max_by_label<Label, std::uint32_t>, "labels"_a.noconvert(),
             "values"_a.noconvert(), "wanted"_a.noconvert(), "threads"_a, "progress"_a.none());
  module.def("max_by_label", &max_by_label<Label, std::uint64_t>, "labels"_a.noconvert(),
             "values"_a.noconvert(), "wanted"_a.noconvert(), "threads"_a, "progress"_a.none());
  module.def("mark_diagram", &mark_diagram<Label>, "labels"_a.noconvert(), "above"_a.noconvert().none(),
             "below"_a.noconvert().none(), "out"_a.noconvert(), "threads"_a, "progress"_a.none());
  module.def("verify_tessellation", &verify_tessellation<Label>, "labels"_a.noconvert(), "x"_a, "y"_a,
             "seed_x"_a.noconvert(), "seed_y"_a.noconvert(), "seed_labels"_a.noconvert(), "scale"_a,
             "limit_high"_a.none(), "limit_low"_a, "threads"_a, "progress"_a.none());
}

}  // namespace

void bind_regions(nb::module_& module) {
  bind_label_image<std::uint8_t>(module);
  bind_label_image<std::uint16_t>(module);
  bind_label_image<std::uint32_t>(module);
  module.def("nearest_other_sites", &nearest_other_sites, "x"_a.noconvert(), "y"_a.noconvert(),
             "labels"_a.noconvert(), "threads"_a, "progress"_a.none());
  module.def("colour_graph", &colour_graph, "vertices"_a, "a"_a.noconvert(), "b"_a.noconvert(),
             "progress"_a.none());
}

}  // namespace vorotool::bindings
