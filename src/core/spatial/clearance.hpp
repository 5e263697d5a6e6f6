// How far places are from the nearest of points and segments.
#pragma once

#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/kernel/lattice.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::spatial {

// From a closed site, right to a few ulp of the coordinates.
double closed_distance(const kernel::LatticeSite& site, const kernel::Point& place);

// For each place on the lattice, the distance of the nearest closed site that is not farther than its reach
// (or a little more), or infinity: right to a few ulp of the coordinates.
std::vector<double> clearances(std::span<const kernel::LatticeSite> sites,
                               std::span<const kernel::Point> places, std::span<const double> reach,
                               unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::spatial
