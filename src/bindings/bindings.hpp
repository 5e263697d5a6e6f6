// Shared by the parts of the extension module: one function a part, called by module.cpp.
#pragma once

#include <nanobind/nanobind.h>

namespace vorotool::bindings {

void bind_text(nanobind::module_& module);
void bind_packed_bytes(nanobind::module_& module);
void bind_tessellation(nanobind::module_& module);
void bind_regions(nanobind::module_& module);
void bind_components(nanobind::module_& module);
void bind_predicates(nanobind::module_& module);
void bind_delaunay(nanobind::module_& module);
void bind_alpha(nanobind::module_& module);
void bind_digital(nanobind::module_& module);
void bind_cells(nanobind::module_& module);
void bind_paths(nanobind::module_& module);
void bind_planar_graph(nanobind::module_& module);
void bind_pruning(nanobind::module_& module);
void bind_exact_signs(nanobind::module_& module);
void bind_insertion_predicates(nanobind::module_& module);
void bind_outlines(nanobind::module_& module);
void bind_skeleton(nanobind::module_& module);
void bind_offsets(nanobind::module_& module);
void bind_sampled_skeleton(nanobind::module_& module);
void bind_segment_verification(nanobind::module_& module);
void bind_segment_voronoi(nanobind::module_& module);

}  // namespace vorotool::bindings
