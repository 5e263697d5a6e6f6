// The alpha complex of points in space.
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/base/indices.hpp"
#include "core/tetrahedral_alpha/space_complex.hpp"

namespace vorotool::bindings {
namespace {

Columns space_complex(const Places& points, const IndexRows& tetrahedra, const IndexRows& neighbors,
                      const IndexRows& triangles, const IndexRows& edges, unsigned threads,
                      const Progress& progress) {
  using namespace core::tetrahedral_alpha;
  const SpaceInput input{rows<core::tetrahedra::Point3>(points), rows<Row>(tetrahedra), rows<Row>(neighbors),
                         rows<Corners>(triangles), rows<Ends>(edges)};
  if (tetrahedra.shape(0) != neighbors.shape(0))
    throw std::invalid_argument("each tetrahedron must have neighbors");
  for (const IndexRows& cells : {tetrahedra, triangles, edges})
    core::base::check_range(view(cells), 0, points.shape(0), "an index is out of range");
  core::base::check_range(view(neighbors), -1, tetrahedra.shape(0), "an index is out of range");
  SpaceArrays found = run_interruptible(progress, core::tetrahedral_alpha::space_complex, input, threads);
  Columns out;
  const auto put = [&](const char* name, auto& values) {
    const std::size_t size = values.size();
    out[name] = to_numpy(std::move(values), {size});
  };
  put("tetrahedron_rank", found.tetrahedron_rank);
  put("facet", found.facet);
  put("triangle_min", found.triangle_min);
  const std::size_t count = found.edges.size();
  auto* const ends = reinterpret_cast<std::int32_t*>(found.edges.release());
  out["edges"] = Array<std::int32_t>(ends, {count, 2}, nb::capsule(ends, [](void* p) noexcept {
                                       core::base::LargeArray<Ends>::free(static_cast<Ends*>(p));
                                     }));
  put("edge_min", found.edge_min);
  put("edge_mid", found.edge_mid);
  put("edge_max", found.edge_max);
  put("spectrum", found.spectrum);
  put("witness", found.witness);
  return out;
}

}  // namespace

void bind_tetrahedral_alpha(nb::module_& room) {
  room.def("space_complex", &space_complex, "points"_a, "tetrahedra"_a, "neighbors"_a, "triangles"_a,
           "edges"_a, "threads"_a, "progress"_a.none(),
           "Ranks in the spectrum: of tetrahedra, triangles and edges; facet is 4 t + k of each triangle.");
}

}  // namespace vorotool::bindings
