// The digital triangulation, to the letter and repaired.
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/delaunay/delaunay_triangulation.hpp"
#include "core/digital/digital_repair.hpp"
#include "core/digital/digital_triangulation.hpp"

namespace vorotool::bindings {
namespace {

using core::base::Monitor;
using core::delaunay::DelaunayTriangulation;
using core::delaunay::OrderedPoints;
using core::digital::DigitalRepair;
using core::digital::DigitalTriangulationScan;
using core::digital::LabelPair;
using core::digital::LabelTriple;
using Coordinates = Vector<const std::int64_t>;

template <class Label>
void add_rows(DigitalTriangulationScan& scan, const Matrix<const Label>& rows, unsigned threads,
              const Progress& progress) {
  run_interruptible(progress, [&](const Monitor& monitor) {
    scan.add_rows<Label>(view(rows), rows.shape(1), threads, monitor);
  });
}

Columns finish(DigitalTriangulationScan& scan) {
  const auto found = run_interruptible({}, [&](const Monitor&) { return scan.finish(); });
  Columns columns;
  columns["edge_a"] = column<std::uint32_t>(found.edges, [](const LabelPair& e) { return e.a; });
  columns["edge_b"] = column<std::uint32_t>(found.edges, [](const LabelPair& e) { return e.b; });
  columns["triangle_a"] = column<std::uint32_t>(found.triangles, [](const LabelTriple& t) { return t.a; });
  columns["triangle_b"] = column<std::uint32_t>(found.triangles, [](const LabelTriple& t) { return t.b; });
  columns["triangle_c"] = column<std::uint32_t>(found.triangles, [](const LabelTriple& t) { return t.c; });
  columns["corners"] = column<std::uint8_t>(found.triangles, [](const LabelTriple& t) { return t.corners; });
  columns["three_label_corners"] = found.three_label_corners;
  columns["four_label_corners"] = found.four_label_corners;
  return columns;
}

Columns as_dict(const DigitalRepair& repair) {
  static constexpr const char* routes[] = {"chain", "repaired", "rebuilt"};
  Columns counts;
  counts["route"] = routes[repair.route];
  counts["split_regions"] = repair.split_regions;
  counts["moved_pixels"] = repair.moved_pixels;
  counts["three_label_corners"] = repair.three_label_corners;
  counts["four_label_corners"] = repair.four_label_corners;
  counts["twins"] = repair.twins;
  counts["straightened"] = repair.straightened;
  counts["filled"] = repair.filled;
  counts["flipped"] = repair.flipped;
  counts["inserted"] = repair.inserted;
  return counts;
}

// The mesh, and what its repair took. The labels of the image are those of its connected regions afterwards.
auto digital_mesh(const Places& points, const Coordinates& x, const Coordinates& y, std::int64_t scale,
                  const Matrix<std::uint32_t>& image, std::int64_t frame_x, std::int64_t frame_y,
                  unsigned threads, const Progress& progress) {
  if (x.size() != points.shape(0) || y.size() != points.shape(0))
    throw std::invalid_argument("sites and points differ in number");
  const core::tessellation::PixelFrame frame{frame_x, frame_y, image.shape(1), image.shape(0)};
  DigitalRepair repair;
  DelaunayTriangulation mesh = run_interruptible(progress, [&](const Monitor& monitor) {
    const auto triangulate = [&](const OrderedPoints& ordered) {
      return core::digital::digital_delaunay(view(image), frame, {view(x), view(y), scale}, ordered, repair,
                                             threads, monitor);
    };
    return DelaunayTriangulation(rows<core::kernel::Point>(points), triangulate, threads, monitor);
  });
  return std::make_tuple(std::move(mesh), as_dict(repair));
}

DelaunayTriangulation inserted_mesh(const Places& points, unsigned threads, const Progress& progress) {
  return run_interruptible(progress, [&](const Monitor& monitor) {
    const auto triangulate = [&](const OrderedPoints& ordered) {
      return core::digital::delaunay_by_insertion(ordered, monitor);
    };
    return DelaunayTriangulation(rows<core::kernel::Point>(points), triangulate, threads, monitor);
  });
}

}  // namespace

void bind_digital(nb::module_& room) {
  nb::class_<DigitalTriangulationScan>(room, "DigitalTriangulationScan")
      .def(nb::init<>())
      .def("add_rows", &add_rows<std::uint8_t>, "rows"_a, "threads"_a, "progress"_a.none())
      .def("add_rows", &add_rows<std::uint16_t>, "rows"_a, "threads"_a, "progress"_a.none())
      .def("add_rows", &add_rows<std::uint32_t>, "rows"_a, "threads"_a, "progress"_a.none())
      .def("finish", &finish);
  room.def("digital_mesh", &digital_mesh, "points"_a, "x"_a, "y"_a, "scale"_a, "image"_a, "frame_x"_a,
           "frame_y"_a, "threads"_a, "progress"_a.none(), "The mesh, and what its repair took.");
  room.def("inserted_mesh", &inserted_mesh, "points"_a, "threads"_a, "progress"_a.none());
}

}  // namespace vorotool::bindings
