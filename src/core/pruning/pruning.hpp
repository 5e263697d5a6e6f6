// Pruning: the part of a skeleton that a threshold keeps.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"
#include "core/pruning/critical_values.hpp"
#include "core/skeleton/skeleton_view.hpp"

namespace vorotool::core::pruning {

// The part of an arc that is left: from one parameter to another, the same where it is a single place.
struct ArcPart {
  std::int32_t arc;
  double first, last;
};

// Its ends, its control point (NaN where it is straight), and its length.
struct PartGeometry {
  skeleton::ArcEnd first, last;
  kernel::Point control;
  double length;
};
PartGeometry part_geometry(const skeleton::SkeletonView& skeleton, const ArcPart& part);

// By arc: the places whose critical value is at least the threshold.
std::vector<ArcPart> parts_left(const skeleton::SkeletonView& skeleton, const CriticalValues& values,
                                Criterion criterion, double threshold);

// Arcs branch by branch, as of a whole skeleton.
struct PrunedSkeleton {
  std::vector<kernel::Point> vertices;    // [v]
  std::vector<double> radius;             // [v]
  std::vector<base::IndexPair> arcs;      // [a]
  std::vector<kernel::Point> control;     // [a] NaN on straight lines
  std::vector<double> length;             // [a]
  std::vector<std::int32_t> branch;       // [a]
  std::vector<std::int32_t> original;     // [a] the arc that each is a part of
  std::vector<std::uint8_t> is_reversed;  // [a] runs against that
};

// Of parts with the groups of their arcs: groups stay together.
PrunedSkeleton pruned_skeleton(const skeleton::SkeletonView& skeleton, std::span<const ArcPart> parts,
                               std::span<const std::int32_t> group, const base::Monitor& monitor);

}  // namespace vorotool::core::pruning
