// Alpha complexes, alpha shapes and their curves.
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/triangulation.hpp"
#include "core/alpha/alpha_complex.hpp"
#include "core/alpha/alpha_curves.hpp"
#include "core/alpha/alpha_shape.hpp"
#include "core/alpha/region_persistence.hpp"
#include "core/base/indices.hpp"

namespace vorotool::bindings {
namespace {

using core::alpha::AlphaRule;
using Values = Vector<const double>;

// The binding trusts nobody with indices: a wrong one would read elsewhere.
void check_indices(std::span<const std::int32_t> values, std::int32_t least, std::size_t end) {
  core::base::check_range(values, least, end, "an index is out of range");
}

auto edges_of_triangles(const IndexRows& triangles, const IndexRows& neighbors, unsigned threads,
                        const Progress& progress) {
  if (triangles.shape(0) != neighbors.shape(0))
    throw std::invalid_argument("each triangle must have neighbors");
  check_indices(rows_of(neighbors, 3), -1, neighbors.shape(0));
  core::alpha::EdgeArrays found = run_interruptible(progress, core::alpha::edges_of_triangles,
                                                    rows_of(triangles, 3), rows_of(neighbors, 3), threads);
  const std::size_t rows = found.ends.size() / 2;
  return std::make_tuple(to_numpy(std::move(found.ends), {rows, 2}),
                         to_numpy(std::move(found.sides), {rows, 2}));
}

Columns alpha_complex(const Matrix<const double>& points, const IndexRows& triangles, const IndexRows& edges,
                      const IndexRows& sides, AlphaRule rule, unsigned threads, const Progress& progress) {
  const core::alpha::AlphaInput input{rows<core::kernel::Point>(points), rows_of(triangles, 3),
                                      rows_of(edges, 2), rows_of(sides, 2)};
  if (edges.shape(0) != sides.shape(0)) throw std::invalid_argument("each edge must have sides");
  check_indices(input.triangles, 0, input.points.size());
  check_indices(input.edges, 0, input.points.size());
  check_indices(input.sides, -1, triangles.shape(0));
  core::alpha::AlphaArrays found =
      run_interruptible(progress, core::alpha::alpha_complex, input, rule, threads);
  Columns out;
  const auto put = [&](const char* name, auto& values) {
    const std::size_t size = values.size();
    out[name] = to_numpy(std::move(values), {size});
  };
  put("r_min", found.r_min);
  put("r_mid", found.r_mid);
  put("r_max", found.r_max);
  put("rank_min", found.rank_min);
  put("rank_mid", found.rank_mid);
  put("rank_max", found.rank_max);
  put("triangle_rank", found.triangle_rank);
  put("spectrum", found.spectrum);
  put("witness", found.witness);
  return out;
}

core::alpha::EdgeRanks ranks_of(const Indices& min, const Indices& mid, const Indices& max) {
  if (min.size() != mid.size() || min.size() != max.size())
    throw std::invalid_argument("ranks differ in length");
  return {view(min), view(mid), view(max)};
}

auto shape_edges(const Indices& min, const Indices& mid, const Indices& max, std::int32_t reached,
                 std::int32_t entered, unsigned threads, const Progress& progress) {
  const core::alpha::EdgeRanks ranks = ranks_of(min, mid, max);
  core::alpha::ShapeEdges found =
      run_interruptible(progress, core::alpha::shape_edges, ranks, reached, entered, threads);
  return std::make_tuple(to_numpy(std::move(found.edge), {found.count}),
                         to_numpy(std::move(found.kind), {found.count}));
}

auto connected_triangles(const Vector<const std::uint8_t>& inside, const IndexRows& sides,
                         const Progress& progress) {
  check_indices(rows_of(sides, 2), -1, inside.size());
  return to_numpy(
      run_interruptible(progress, core::alpha::connected_triangles, view(inside), rows_of(sides, 2)));
}

auto trace_rings(const Matrix<const double>& points, const Indices& a, const Indices& b,
                 const Indices& region, const Progress& progress) {
  if (a.size() != b.size() || a.size() != region.size())
    throw std::invalid_argument("columns differ in length");
  check_indices(view(a), 0, points.shape(0));
  check_indices(view(b), 0, points.shape(0));
  core::alpha::Rings rings = run_interruptible(
      progress, core::alpha::trace_rings, rows<core::kernel::Point>(points), view(a), view(b), view(region));
  return std::make_tuple(to_numpy(std::move(rings.vertex)), to_numpy(std::move(rings.start)),
                         to_numpy(std::move(rings.region)), to_numpy(std::move(rings.is_hole)));
}

Columns alpha_curves(std::size_t spectrum, const Indices& cell_rank, const IndexRows& sides,
                     const Indices& wall_rank, const Values& cell_size, const Values& wall_size,
                     const Progress& progress) {
  const core::alpha::CurveInput input{spectrum,        view(cell_rank), rows<core::base::IndexPair>(sides),
                                      view(wall_rank), view(cell_size), view(wall_size)};
  if (cell_size.size() != cell_rank.size() || wall_size.size() != wall_rank.size() ||
      input.sides.size() != wall_rank.size())
    throw std::invalid_argument("columns differ in length");
  for (const auto ranks : {input.cell_rank, input.wall_rank}) check_indices(ranks, 0, spectrum + 1);
  check_indices(view(sides), -1, cell_rank.size());
  core::alpha::Curves found = run_interruptible(progress, core::alpha::alpha_curves, input);
  Columns out;
  out["content"] = to_numpy(std::move(found.content), {spectrum});
  out["border"] = to_numpy(std::move(found.border), {spectrum});
  out["regions"] = to_numpy(std::move(found.regions), {spectrum});
  out["cavities"] = to_numpy(std::move(found.cavities), {spectrum});
  return out;
}

auto part_counts(std::size_t spectrum, std::size_t points, const IndexRows& edges, const Indices& edge_rank,
                 const Progress& progress) {
  const auto ends = rows<core::base::IndexPair>(edges);
  if (ends.size() != edge_rank.size()) throw std::invalid_argument("columns differ in length");
  check_indices(view(edges), 0, std::size_t{1} << 31);
  check_indices(view(edge_rank), 0, spectrum + 1);
  return to_numpy(
      run_interruptible(progress, core::alpha::part_counts, spectrum, points, ends, view(edge_rank)),
      {spectrum});
}

Columns region_persistence(std::size_t spectrum, std::size_t points, const IndexRows& triangles,
                           const Indices& triangle_rank, const Indices& rank_max, const IndexRows& sides,
                           const Values& area, const Progress& progress) {
  const core::alpha::RegionInput input{
      spectrum,          points,    rows_of(triangles, 3), view(triangle_rank), view(rank_max),
      rows_of(sides, 2), view(area)};
  if (triangles.shape(0) != triangle_rank.size() || area.size() != triangle_rank.size() ||
      sides.shape(0) != rank_max.size())
    throw std::invalid_argument("columns differ in length");
  check_indices(input.triangles, 0, points);
  for (const auto ranks : {input.triangle_rank, input.rank_max}) check_indices(ranks, 0, spectrum + 1);
  check_indices(input.sides, -1, triangle_rank.size());
  for (std::size_t e = 0; e < rank_max.size(); ++e) {
    if (view(rank_max)[e] < static_cast<std::int32_t>(spectrum) &&
        (input.sides[2 * e] < 0 || input.sides[2 * e + 1] < 0))
      throw std::invalid_argument("an edge between two triangles has one");
  }
  core::alpha::Regions found = run_interruptible(progress, core::alpha::region_persistence, input);
  Columns out;
  out["birth"] = to_numpy(std::move(found.birth));
  out["death"] = to_numpy(std::move(found.death));
  out["into"] = to_numpy(std::move(found.into));
  out["triangle"] = to_numpy(std::move(found.triangle));
  out["vertices"] = to_numpy(std::move(found.vertices));
  out["triangles"] = to_numpy(std::move(found.triangles));
  out["area"] = to_numpy(std::move(found.area));
  return out;
}

}  // namespace

void bind_alpha(nb::module_& room) {
  nb::enum_<AlphaRule>(room, "AlphaRule")
      .value("corrected", AlphaRule::corrected)
      .value("printed", AlphaRule::printed);
  room.def("edges_of_triangles", &edges_of_triangles, "triangles"_a, "neighbors"_a, "threads"_a,
           "progress"_a.none(), "Edges, and the triangles on their sides.");
  room.def("alpha_complex", &alpha_complex, "points"_a, "triangles"_a, "edges"_a, "sides"_a, "rule"_a,
           "threads"_a, "progress"_a.none());
  room.def("shape_edges", &shape_edges, "rank_min"_a, "rank_mid"_a, "rank_max"_a, "reached"_a, "entered"_a,
           "threads"_a, "progress"_a.none(), "Edges of a shape, and the kind of each.");
  room.def("connected_triangles", &connected_triangles, "inside"_a, "sides"_a, "progress"_a.none());
  room.def("trace_rings", &trace_rings, "points"_a, "a"_a, "b"_a, "region"_a, "progress"_a.none(),
           "Vertices of all rings, where each begins, its region, and whether it is a hole.");
  room.def("alpha_curves", &alpha_curves, "spectrum"_a, "cell_rank"_a, "sides"_a, "wall_rank"_a,
           "cell_size"_a, "wall_size"_a, "progress"_a.none(),
           "Content, border, regions and cavities of the shape of each rank, in the plane or in space.");
  room.def("part_counts", &part_counts, "spectrum"_a, "points"_a, "edges"_a, "edge_rank"_a,
           "progress"_a.none());
  room.def("region_persistence", &region_persistence, "spectrum"_a, "points"_a, "triangles"_a,
           "triangle_rank"_a, "rank_max"_a, "sides"_a, "area"_a, "progress"_a.none(),
           "Ranks of birth and death of regions, what each becomes part of, and its sizes before that.");
}

}  // namespace vorotool::bindings
