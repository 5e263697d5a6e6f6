// Cuts a box by planes, with exact combinatorics.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/cells_in_space/cell_planes.hpp"

namespace vorotool::core::cells_in_space {

// The part of the box that is inside the planes cut so far: a convex polyhedron, or nothing.
//
// Each vertex knows all planes through it, also those that only touch there. Signs at vertices are exact, vertices on a
// plane stay as they are, and an edge is cut where its ends are on different sides: all faces and vertices are proper,
// whatever planes coincide.
class BoxCutter {
 public:
  using Index = std::int32_t;

  struct Vertex {
    Meeting at;
    std::vector<Index> through;  // the planes, in their order
  };
  struct Face {
    Index plane;
    std::vector<Index> corners;  // counter-clockwise as seen from outside
  };

  // The whole box, of which the first planes are the sides.
  void begin(const CellPlanes& planes);
  // Cuts off what is beyond a plane, which must be greater than those before. False if nothing is left.
  bool cut(Index plane);

  std::span<const Face> faces() const { return faces_; }
  std::span<const Index> vertices() const { return live_; }  // those that faces have
  const Vertex& vertex(Index v) const { return vertices_[static_cast<std::size_t>(v)]; }

 private:
  struct Crossing {
    Index inside, outside, plane, vertex;
  };

  int sign(Index v) const { return sign_[static_cast<std::size_t>(v)]; }
  Index crossing(Index inside, Index outside, Index of, Index plane);
  bool cut_face(Face& face, Index plane);
  void close(Index plane);

  const CellPlanes* planes_ = nullptr;
  std::vector<Vertex> vertices_;
  std::vector<int> sign_;  // of each vertex; 0 of those that are new
  std::vector<Index> live_, kept_;
  std::vector<Face> faces_;
  std::vector<Crossing> crossings_;
  std::vector<std::pair<Index, Index>> edges_;  // of the face that closes the polyhedron
};

}  // namespace vorotool::core::cells_in_space
