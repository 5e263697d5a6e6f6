// The extension module vorotool._core: conversions only; the algorithms are in src/core.
#include "bindings.hpp"

NB_MODULE(_core, module) {
  module.doc() = "Compiled core of vorotool (private: use the functions of the package).";
  vorotool::bindings::bind_text(module);
  vorotool::bindings::bind_packed_bytes(module);
  vorotool::bindings::bind_tessellation(module);
  vorotool::bindings::bind_regions(module);
  vorotool::bindings::bind_components(module);
  vorotool::bindings::bind_predicates(module);
  vorotool::bindings::bind_delaunay(module);
  vorotool::bindings::bind_alpha(module);
  vorotool::bindings::bind_digital(module);
  vorotool::bindings::bind_cells(module);
  vorotool::bindings::bind_paths(module);
  vorotool::bindings::bind_planar_graph(module);
  vorotool::bindings::bind_pruning(module);
  vorotool::bindings::bind_exact_signs(module);
  vorotool::bindings::bind_insertion_predicates(module);
  vorotool::bindings::bind_outlines(module);
  vorotool::bindings::bind_skeleton(module);
  vorotool::bindings::bind_offsets(module);
  vorotool::bindings::bind_sampled_skeleton(module);
  vorotool::bindings::bind_segment_verification(module);
  vorotool::bindings::bind_segment_voronoi(module);
}
