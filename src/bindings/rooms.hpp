// One function a room of the core, called by module.cpp.
#pragma once

#include <nanobind/nanobind.h>

namespace vorotool::bindings {

void bind_alpha(nanobind::module_& room);
void bind_arrangement(nanobind::module_& room);
void bind_cells(nanobind::module_& room);
void bind_cells_in_space(nanobind::module_& room);
void bind_compression(nanobind::module_& room);
void bind_delaunay(nanobind::module_& room);
void bind_digital(nanobind::module_& room);
void bind_distances(nanobind::module_& room);
void bind_graphs(nanobind::module_& room);
void bind_kernel(nanobind::module_& room);
void bind_label_images(nanobind::module_& room);
void bind_offsets(nanobind::module_& room);
void bind_proximity(nanobind::module_& room);
void bind_pruning(nanobind::module_& room);
void bind_sampled_skeleton(nanobind::module_& room);
void bind_segment_voronoi(nanobind::module_& room);
void bind_skeleton(nanobind::module_& room);
void bind_spatial(nanobind::module_& room);
void bind_tessellation(nanobind::module_& room);
void bind_tetrahedra(nanobind::module_& room);
void bind_tetrahedral_alpha(nanobind::module_& room);
void bind_text(nanobind::module_& room);
void bind_thickness(nanobind::module_& room);
void bind_voronoi(nanobind::module_& room);
void bind_volumes(nanobind::module_& room);

}  // namespace vorotool::bindings
