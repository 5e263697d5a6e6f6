// A triangulation that is worked on: flips, and insertion of single points where they lie.
//
// The plane is closed to a sphere by one vertex at infinity, so that every side has a twin: beyond a side a,
// b of the hull lies the ghost triangle b, a, infinity.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/delaunay/divide_and_conquer.hpp"
#include "core/delaunay/half_edge.hpp"
#include "core/delaunay/vertex_links.hpp"
#include "core/kernel/predicates.hpp"

namespace vorotool::core::delaunay {

class FlipMesh {
 public:
  using Side = HalfEdge;  // leaves its corner
  static constexpr Vertex infinity = -1;

  // Distinct points; none is in the mesh yet.
  FlipMesh(std::span<RingVertex> vertices, const base::Monitor& monitor)
      : vertices_(vertices), monitor_(monitor) {}

  // Adds a triangle, ghosts included; its sides have no twins yet. Returns its first side.
  Side add_triangle(Vertex a, Vertex b, Vertex c);
  void link(Side one, Side other) {
    twin(one) = other;
    twin(other) = one;
  }
  // Links the sides of three points, in any order but not collinear, and their ghosts: a first triangle.
  void start(Vertex a, Vertex b, Vertex c);

  // Takes triangles of collinear corners out: the side between the outer two is flipped, which leaves proper
  // triangles where the neighbor across it is one. Returns the number of such flips.
  std::uint64_t straighten();
  // Whether all triangles but ghosts are counter-clockwise.
  bool is_positive() const;
  bool has_triangle() const;  // other than ghosts

  // Fills the reflex turns of the hull, as Graham's scan does, and flips all sides that are not locally
  // Delaunay (Lawson). Cocircular polygons become fans from their lexicographically smallest vertices.
  void make_delaunay();
  // Inserts a point, near the last one if possible, into a Delaunay triangulation with a triangle; the mesh
  // is Delaunay after it.
  void insert(Vertex v);

  // Makes the rings of the vertices; nothing if the mesh is no sphere that has all points as vertices.
  std::optional<Subdivision> subdivision();

  std::uint64_t flips() const { return flips_; }
  std::uint64_t fills() const { return fills_; }

 private:
  Side sides() const { return static_cast<Side>(origins_.size()); }
  Vertex& origin(Side s) { return origins_[static_cast<std::size_t>(s)]; }
  Vertex origin(Side s) const { return origins_[static_cast<std::size_t>(s)]; }
  Vertex target(Side s) const { return origin(following(s)); }
  Vertex apex(Side s) const { return origin(preceding(s)); }
  Side& twin(Side s) { return twins_[static_cast<std::size_t>(s)]; }
  Side twin(Side s) const { return twins_[static_cast<std::size_t>(s)]; }
  const kernel::Point& at(Vertex v) const { return vertices_[static_cast<std::size_t>(v)].point; }
  int side_of(Side s, Vertex v) const { return kernel::orient2d(at(origin(s)), at(target(s)), at(v)); }
  bool is_ghost(Side s) const {
    return origin(s) == infinity || target(s) == infinity || apex(s) == infinity;
  }

  Side opposite_to_middle(Side s) const;
  bool is_flat(Side s) const { return !is_ghost(s) && side_of(s, apex(s)) == 0; }
  bool is_wrong(Side s) const;
  void flip(Side s);
  void settle();
  Side find(Vertex v) const;
  void split(Side s, Vertex v);
  void poll();
  Side make_ring(Side start, RingStore& store);

  std::span<RingVertex> vertices_;
  const base::Monitor& monitor_;
  std::vector<Vertex> origins_;
  std::vector<Side> twins_;
  std::vector<Side> doubtful_;  // sides to be looked at
  Side recent_ = 0;
  std::uint64_t flips_ = 0, fills_ = 0;
  std::size_t steps_ = 0;
};

}  // namespace vorotool::core::delaunay
