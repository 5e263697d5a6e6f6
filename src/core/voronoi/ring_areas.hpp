// Areas in rings of arcs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/indices.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::core::voronoi {

// [r] signed areas: above 0 of rings that go counter-clockwise. `bulge` is the signed area between the chord
// of each arc and the arc; half-edge 2 k goes along arc k, 2 k + 1 back. Triangles are taken from the place
// where a ring begins, so that small rings far from the origin keep their sign.
std::vector<double> ring_areas(std::span<const std::int64_t> start, std::span<const std::int64_t> half_edge,
                               std::span<const base::IndexPair> ends, std::span<const kernel::Point> places,
                               std::span<const double> bulge);

}  // namespace vorotool::core::voronoi
