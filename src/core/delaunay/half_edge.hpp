// Half-edges of triangles in flat arrays: 3 t + k is the one of triangle t that goes with its corner k, which
// it leaves or is opposite to. A corner alone, k, is a half-edge of triangle 0.
#pragma once

#include <cstdint>

namespace vorotool::core::delaunay {

using HalfEdge = std::int32_t;

// Counter-clockwise around the triangle.
template <class Index>
constexpr Index following(Index h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
template <class Index>
constexpr Index preceding(Index h) {
  return h % 3 == 0 ? h + 2 : h - 1;
}

}  // namespace vorotool::core::delaunay
