// What is nearest, and which boxes are disjoint.
#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/base/parallel.hpp"
#include "core/kernel/planar_graph_view.hpp"
#include "core/spatial/clearance.hpp"
#include "core/spatial/disjoint_boxes.hpp"
#include "core/spatial/nearest_sites.hpp"

namespace vorotool::bindings {
namespace {

using core::base::Monitor;
using core::spatial::NearestOther;

template <std::size_t Axes>
auto nearest_among(const std::array<std::span<const double>, Axes>& columns,
                   const Vector<const std::uint32_t>& labels, unsigned threads, const Progress& progress) {
  for (const auto& column : columns) {
    if (column.size() != labels.size()) throw std::invalid_argument("each site must have one label");
  }
  const auto found =
      run_interruptible(progress, core::spatial::nearest_other_sites<Axes>, columns, view(labels), threads);
  return std::make_tuple(column<std::int64_t>(found, [](const NearestOther& n) { return n.index; }),
                         column<double>(found, [](const NearestOther& n) { return n.distance; }));
}

auto nearest_other_sites(const Vector<const double>& x, const Vector<const double>& y,
                         const Vector<const std::uint32_t>& labels, unsigned threads,
                         const Progress& progress) {
  return nearest_among<2>({view(x), view(y)}, labels, threads, progress);
}

auto nearest_other_in_space(const Vector<const double>& x, const Vector<const double>& y,
                            const Vector<const double>& z, const Vector<const std::uint32_t>& labels,
                            unsigned threads, const Progress& progress) {
  return nearest_among<3>({view(x), view(y), view(z)}, labels, threads, progress);
}

// Distances of places on the lattice from the nearest of points and segments.
auto clearances(const IndexRows& points, const IndexRows& segments, const Places& places,
                const Vector<const double>& reach, unsigned threads, const Progress& progress) {
  const core::kernel::PlanarGraphView graph{
      rows<core::kernel::LatticePoint>(points), rows<core::base::IndexPair>(segments), {}};
  if (places.shape(0) != reach.size()) throw std::invalid_argument("each place must have one reach");
  core::base::check_range(graph.segments, 0, graph.points.size(), "an end of a segment is out of range");
  std::vector<double> found = run_interruptible(progress, [&](const Monitor& monitor) {
    std::vector<core::kernel::LatticeSite> sites;
    sites.reserve(graph.site_count());
    for (std::size_t i = 0; i < graph.site_count(); ++i)
      sites.push_back(graph.site(static_cast<std::int32_t>(i)));
    return core::spatial::clearances(sites, rows<core::kernel::Point>(places), view(reach),
                                     core::base::resolve_threads(threads), monitor);
  });
  return to_numpy(std::move(found));
}

// The sheet of each box, with the columns least x, least y, most x, most y.
auto disjoint_sheets(const Matrix<const std::int64_t>& boxes, const Progress& progress) {
  const std::span<const core::spatial::ClosedBox> closed = rows<core::spatial::ClosedBox>(boxes);
  return to_numpy(run_interruptible(progress, core::spatial::disjoint_sheets, closed));
}

}  // namespace

void bind_spatial(nb::module_& room) {
  room.def("nearest_other_sites", &nearest_other_sites, "x"_a, "y"_a, "labels"_a, "threads"_a,
           "progress"_a.none(), "Of each site the nearest with another label, and its distance.");
  room.def("nearest_other_sites", &nearest_other_in_space, "x"_a, "y"_a, "z"_a, "labels"_a, "threads"_a,
           "progress"_a.none());
  room.def("clearances", &clearances, "points"_a, "segments"_a, "places"_a, "reach"_a, "threads"_a,
           "progress"_a.none(), "Of the nearest site within reach; infinite where there is none.");
  room.def("disjoint_sheets", &disjoint_sheets, "boxes"_a, "progress"_a.none(),
           "Of boxes with the columns least x, least y, most x, most y.");
}

}  // namespace vorotool::bindings
