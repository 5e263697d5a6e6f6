// The faces of the shapes that Voronoi vertices of seeds lie in.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/sampled_skeleton/boundary_crossings.hpp"
#include "core/sampled_skeleton/sample_labels.hpp"
#include "core/sampled_skeleton/sample_mesh.hpp"

namespace vorotool::core::sampled_skeleton {

struct SampleFaceInput {
  const SampleMesh& mesh;
  const SampleLabels& labels;
  std::span<const std::uint8_t> state;        // [sides] SideState, the same of both sides of an edge
  std::span<const std::uint8_t> is_on_shape;  // [triangles] whose circumcenter is on a piece; or empty
  std::span<const Crossing> crossings;        // by pieces that are not the own ones of sides
};

// [triangles] -1 on pieces. No coordinate is looked at but for the order in which several pieces cross one
// edge: an edge that is crossed leads from the left of a piece to its right, one that is not stays in its
// face, and unbounded ones end in face 0.
std::vector<std::int32_t> sample_faces(const SampleFaceInput& input, unsigned threads,
                                       const base::Monitor& monitor);

}  // namespace vorotool::core::sampled_skeleton
