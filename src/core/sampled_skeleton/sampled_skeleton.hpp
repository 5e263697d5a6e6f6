// The approximate skeleton: what is kept of the Voronoi diagram of seeds, in the order of branches, with
// certified bounds of its errors (paper, section 3.1).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/monitor.hpp"
#include "core/sampled_skeleton/sample_diagram.hpp"
#include "core/skeleton/extraction.hpp"
#include "core/skeleton/frame_clip.hpp"

namespace vorotool::core::sampled_skeleton {

struct SampledSkeletonOptions {
  std::span<const std::int32_t> face_group;       // [faces] of the arcs in each; negative: not wanted
  std::optional<skeleton::ClippedGroup> clipped;  // unbounded arcs are in this group
  bool whole = false;     // all Voronoi edges, of group 0 and without bounds: nothing is deleted
  bool complete = false;  // corners are joined
  double tolerance = 0;   // of errors, in lattice steps: what `parts` are asked for
  // Lines of one of these groups that complete one corner have a node in common there
  skeleton::JoinedGroups joined;
};

struct SampledSkeleton {
  // Straight lines only: no control points. Sites are points, then segments, of the graph.
  skeleton::SkeletonArrays arrays;
  std::vector<base::IndexPair> seeds;  // [a] left and right; -1 of lines that complete
  std::vector<double> error;           // [a] in input units; infinite where nothing is proved
  // [pieces] into how many each should be divided; empty without a tolerance
  std::vector<std::int32_t> parts;
  std::size_t open_corners = 0;  // that could not be joined
};

SampledSkeleton extract_sampled_skeleton(const SampleDiagram& diagram, const SampledSkeletonOptions& options,
                                         const skeleton::LatticeToInput& place, unsigned threads,
                                         const base::Monitor& monitor);

}  // namespace vorotool::core::sampled_skeleton
