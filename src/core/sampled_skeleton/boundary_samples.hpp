// Seeds on the edges of shapes: sampling (paper, section 3.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/kernel/planar_graph_view.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::sampled_skeleton {

// Seeds are rounded to multiples of this part of a lattice step: below 2^30 steps these are doubles, and
// their differences are, too. A seed is within 2^-21 of a step of its edge: the roundings of its coordinates,
// each of at most half of this, and of what they are computed from.
inline constexpr int seed_bits = 22;
inline constexpr double seed_step = 0x1p-22;

// Distances of seeds from an end of their edge differ by at least this, so that seeds follow each other as
// they should. Each coordinate of those placed from one end is a monotone function of the distance: quotient,
// product, sum and rounding are. Over this distance the larger one grows by more than 2^-17, and is wrong by
// less than 2^-20: it differs. Between two halves is a quarter of the last gap of each, before the end of an
// edge half a step: at least 2^-17 together, where each place is wrong along the edge by less than 2^-19, the
// error of the length included.
inline constexpr double least_gap = 0x1p-16;

// More seeds than there may be; carries how many there would be.
struct TooManySeeds : std::length_error {
  explicit TooManySeeds(double count_) : std::length_error("too many seeds"), count(count_) {}
  double count;
};

// Pieces are what edges are cut into by their seeds: those of segment j are start[j] - n + j ... start[j + 1]
// - n + j, along it.
struct BoundarySamples {
  // [s] the points of the graph, then those inside each segment along it
  base::LargeArray<kernel::Point> seeds;
  base::LargeArray<std::int32_t> segment;  // [s] that each seed lies inside; -1 of points
  std::vector<std::int32_t> start;         // [m + 1] the first seed inside each segment
};

// As the paper prints it: from the first end of a segment at multiples of the step, so that the last gap is
// at least half of it and less than one and a half. A segment shorter than half a step has only its ends.
BoundarySamples sample_by_step(const kernel::PlanarGraphView& graph, double step, std::size_t most,
                               unsigned threads, const base::Monitor& monitor);

// How far from each point the seeds on its segments are: the same on all of them, so that they are placed
// symmetrically about each corner. Each half of a segment has those of its own end.
struct CornerSteps {
  std::vector<std::size_t> start;  // [n + 1]
  std::vector<double> distance;    // [start[n]] increasing for each point
};

// Multiples of the step, up to half of the longest segment at each point.
CornerSteps even_steps(const kernel::PlanarGraphView& graph, double step, std::size_t most);

// A third of the shortest segment at each point, then twice as far each time while gaps are at most
// `coarsest`: what refinement begins with.
CornerSteps doubled_steps(const kernel::PlanarGraphView& graph, double coarsest, std::size_t most);

// Where the halves of a segment meet, a seed is added if the gap there would be more than one and a half of
// the smaller next gap.
BoundarySamples sample_from_corners(const kernel::PlanarGraphView& graph, const CornerSteps& steps,
                                    std::size_t most, unsigned threads, const base::Monitor& monitor);

// Divides the gaps that pieces of edges are made of: [pieces] into how many parts, of `least_gap` at least.
CornerSteps refined_steps(const kernel::PlanarGraphView& graph, const CornerSteps& steps,
                          std::span<const std::int32_t> start, std::span<const std::int32_t> parts,
                          std::size_t most);

}  // namespace vorotool::core::sampled_skeleton
