// The order in which segments are inserted.
#pragma once

#include <cstdint>
#include <vector>

namespace vorotool::core::segment_voronoi::build {

// Round r goes from items[begin[r]] to items[begin[r + 1]].
struct Brio {
  std::vector<std::int32_t> items;
  std::vector<std::size_t> begin;
};

// A biased randomized order (Amenta, Choi and Rote 2003) of `count` items that are numbered along a curve: in
// rounds, each of three quarters of what the later ones leave, and along the curve within a round. The choice
// is a fixed hash of the number: it repeats.
Brio make_brio(std::size_t count);

}  // namespace vorotool::core::segment_voronoi::build
