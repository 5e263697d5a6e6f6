// How the clearance goes along the arcs of a skeleton.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/monitor.hpp"
#include "core/kernel/lattice.hpp"

namespace vorotool::core::skeleton {

struct PlacedSkeleton {
  std::span<const kernel::Point> vertices;           // [v] on the lattice
  std::span<const double> radius;                    // [v] in steps of the lattice
  std::span<const base::IndexPair> arcs;             // [a] source and target
  std::span<const base::IndexPair> sites;            // [a] left and right
  std::span<const kernel::LatticeSite> site_places;  // [s]
  double error;          // bounds that of each coordinate of a vertex, and of a radius
  bool sites_are_exact;  // else doubles decide, and what they leave open is a tie
};

struct ClearanceCourse {
  // At the source and at the target, how the clearance begins to change into the arc: 1 it grows, -1 it shrinks,
  // 0 it is the same everywhere.
  std::vector<std::array<std::int8_t, 2>> slope;  // [a]
  // Where it is least inside, from 0 at the source to 1 at the target; NaN if it is nowhere.
  std::vector<double> least;  // [a]
};

// Between two lines the clearance is linear, and the same everywhere if they are parallel; else there is an apex,
// where it is least, half-way between the two sites. Whether a node comes before the apex is the sign of
// (node - point) * direction, the point being a site: doubles tell, or the node as the center of the exact disc that
// touches both sites and a third one, which another arc there has. Where there is no third one, as where an arc was cut,
// doubles decide.
ClearanceCourse clearance_course(const PlacedSkeleton& skeleton, unsigned threads,
                                 const base::Monitor& monitor);

}  // namespace vorotool::core::skeleton
