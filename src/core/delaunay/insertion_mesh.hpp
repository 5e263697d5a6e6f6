// A Delaunay triangulation into which points can be inserted: triangles with neighbors, closed by ghosts.
//
// Across each side of the hull lies a ghost triangle with a vertex at infinity, so that every triangle has
// three neighbors and a point outside the hull is inserted like any other. A triangle keeps its slot, by
// which arrays that are there already are changed in few places; FlipMesh, whose rings are made anew,
// links the sides of triangles that it only adds. What they share is in core/delaunay/half_edge.hpp and
// the predicates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/delaunay/half_edge.hpp"
#include "core/delaunay/triangulation.hpp"
#include "core/kernel/predicates.hpp"

namespace vorotool::core::delaunay {

class InsertionMesh {
 public:
  using Slot = std::int32_t;    // a triangle's place
  using Vertex = std::int32_t;  // a point

  static constexpr Vertex infinity = -1;

  // The triangulation as given, triangle t in slot t; there must be one. `more` points can be inserted.
  // Throws std::invalid_argument where the arrays are found not to be a triangulation.
  InsertionMesh(const TriangulationArrays& mesh, std::span<const kernel::Point> points, std::size_t more);

  std::size_t slots() const { return slots_; }
  Vertex corner(Slot s, int k) const { return corners_[at(s, k)]; }
  // The triangle across the side opposite to corner k.
  Slot across(Slot s, int k) const { return across_[at(s, k)]; }
  bool is_ghost(Slot s) const {
    return corner(s, 0) == infinity || corner(s, 1) == infinity || corner(s, 2) == infinity;
  }
  int corner_of(Slot s, Vertex v) const;
  const kernel::Point& point(Vertex v) const { return points_[static_cast<std::size_t>(v)]; }

  // Whether a triangle is not as it was given.
  bool is_changed(Slot s) const { return changed_[static_cast<std::size_t>(s)] != 0; }
  // All such, each once.
  std::span<const Slot> changed() const { return changed_slots_; }

  // Inserts a point, searching for it from a triangle. Returns the vertex at its place: another one, if there
  // is. `near` becomes a triangle there.
  Vertex insert(Vertex v, Slot& near);

  // Makes corner k the first one.
  void rotate(Slot s, int k);
  // A triangle at a vertex, found by a search for it from another one.
  Slot slot_at(Vertex v, Slot start) const { return locate(point(v), start).slot; }

  // Makes the cocircular polygons around changed triangles fans from their lexicographically smallest
  // vertices.
  void make_fans();

 private:
  enum class Place { face, side, vertex };
  struct Location {
    Slot slot;
    Place place;
    int k;  // the side opposite to corner k, or corner k
  };
  struct Side {
    Vertex from;
    Slot outside;
    int k;  // outside, the corner opposite to the side
  };

  static std::size_t at(Slot s, int k) {
    return 3 * static_cast<std::size_t>(s) + static_cast<std::size_t>(k);
  }

  void add_ghosts();
  Slot new_slot();
  void set(Slot s, const std::array<Vertex, 3>& corners);
  void link(Slot s, int k, Slot t, int j);
  void mark(Slot s);
  int side_towards(Slot s, Slot t) const;
  int turn(Vertex a, Vertex b, Vertex c) const { return kernel::orient2d(point(a), point(b), point(c)); }

  Location locate(const kernel::Point& p, Slot start) const;
  void insert_in_face(Vertex v, Slot s);
  void insert_on_side(Vertex v, Slot s, int k);
  void legalize();
  bool must_flip(Slot s, Vertex opposite) const;
  void flip(Slot s);

  bool is_diagonal(Slot s, int k) const;
  void make_fan(Slot within);

  std::span<const kernel::Point> points_;
  std::size_t slots_;                 // in use
  base::LargeArray<Vertex> corners_;  // [3 slots] counter-clockwise; of ghosts, as seen from outside the hull
  base::LargeArray<Slot> across_;     // [3 slots]
  std::vector<std::uint8_t> changed_;
  std::vector<Slot> changed_slots_;
  // Triangles with the new vertex at corner 2 whose opposite side is to be looked at
  std::vector<Slot> pending_;
  std::vector<std::uint8_t> fanned_;
};

}  // namespace vorotool::core::delaunay
