// Proximity graphs.
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/triangulation.hpp"
#include "core/proximity/proximity_graphs.hpp"

namespace vorotool::bindings {
namespace {

using core::proximity::ProximityKind;

auto proximity_edges(const Triangulation& mesh, ProximityKind kind, unsigned threads,
                     const Progress& progress) {
  return to_numpy(run_interruptible(progress, core::proximity::proximity_edges, mesh.view(), kind, threads));
}

}  // namespace

void bind_proximity(nb::module_& room) {
  nb::enum_<ProximityKind>(room, "ProximityKind")
      .value("gabriel", ProximityKind::gabriel)
      .value("relative", ProximityKind::relative)
      .value("spanning_tree", ProximityKind::spanning_tree);
  room.def("proximity_edges", &proximity_edges, "mesh"_a, "kind"_a, "threads"_a, "progress"_a.none(),
           "Places of the edges that are in the graph, increasing.");
}

}  // namespace vorotool::bindings
