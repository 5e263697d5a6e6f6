// The extension module vorotool._core_testing: what only tests and benchmarks call, in no wheel.
#include "bindings/testing/rooms.hpp"

NB_MODULE(_core_testing, module) {
  module.doc() = "Parts of the compiled core that only tests call.";
  nanobind::module_ alpha = module.def_submodule("alpha", "Critical radii of edges and triangles.");
  vorotool::bindings::testing::bind_alpha(alpha);
  nanobind::module_ segment_voronoi =
      module.def_submodule("segment_voronoi",
                           "Exact signs, and decisions about a few sites: a site is a row x, y, x, y of "
                           "int32, a disc three sites in "
                           "counter-clockwise order of contact; the sign is 2 where they have no disc.");
  vorotool::bindings::testing::bind_exact_signs(segment_voronoi);
  vorotool::bindings::testing::bind_insertion_predicates(segment_voronoi);
  nanobind::module_ tessellation = module.def_submodule("tessellation", "The floor of the benchmarks.");
  vorotool::bindings::testing::bind_tessellation(tessellation);
}
