// A Delaunay triangulation of space that grows point by point.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/tetrahedra/predicates.hpp"

namespace vorotool::core::tetrahedra {

// Tetrahedra lie in slots of four vertices, which are positive in their order, and four neighbors, each opposite to a
// vertex. A facet of the hull has a ghost beyond it, whose last vertex is infinite; its three others are
// counter-clockwise seen from outside. A point is inserted by removing all tetrahedra whose spheres hold it, ties
// broken, and joining it to the facets around (A. Bowyer 1981, D. Watson 1981). A ghost is removed where the point is
// beyond its facet, or in the plane of that and in the sphere of the tetrahedron within: so no new one is flat, for
// whether a sphere holds a point in the plane of a facet depends on the facet alone, ties included.
class TetrahedralMesh {
 public:
  using Index = std::int32_t;
  using Row = std::array<Index, 4>;

  // Distinct points. Throws std::length_error where there would be more than 2^29 slots, since a facet, numbered
  // 4 slot + place, has 31 bits.
  TetrahedralMesh(std::span<const Point3> points, const SetPredicates& predicates);

  // The first tetrahedron, of vertices that are not coplanar.
  void start(Row vertices);
  void insert(Index v);

  std::size_t slots() const { return slots_; }
  bool is_used(std::size_t slot) const { return removed_[slot] == 0 && rows_[slot][3] != infinity_; }
  // [slots] vertices, and 4 slot + place of the facet across each facet.
  base::LargeArray<Row> take_rows() { return std::move(rows_); }
  base::LargeArray<Row> take_across() { return std::move(across_); }
  Row& row(std::size_t slot) { return rows_[slot]; }
  Row& across(std::size_t slot) { return across_[slot]; }

 private:
  // A facet of the cavity: the tetrahedron to be, in which the new vertex is at `place`, and the facet outside.
  struct Wall {
    Row vertices;
    Index outside;
    int place;
  };

  static std::size_t slot_of(Index facet) { return static_cast<std::size_t>(facet) / 4; }
  static std::size_t place_of(Index facet) { return static_cast<std::size_t>(facet) % 4; }
  static Index facet(std::size_t slot, std::size_t place) { return static_cast<Index>(4 * slot + place); }

  const Point3& point(Index v) const { return points_[static_cast<std::size_t>(v)]; }
  bool is_ghost(std::size_t slot) const { return rows_[slot][3] == infinity_; }

  std::size_t new_slot();
  void grow();
  std::size_t locate(const Point3& p) const;
  bool holds(std::size_t slot, const Point3& p) const;
  void dig(std::size_t slot, Index v);
  void fill();
  void link_few();
  void link_many();
  std::uint8_t number_of(Index v);
  void link(Index a, Index b) {
    across_[slot_of(a)][place_of(a)] = b;
    across_[slot_of(b)][place_of(b)] = a;
  }

  std::span<const Point3> points_;
  const SetPredicates& predicates_;
  const Index infinity_;
  std::size_t slots_ = 0;
  std::size_t last_ = 0;  // where the next search begins: no ghost
  base::LargeArray<Row> rows_, across_;
  base::LargeArray<std::uint8_t> removed_;
  std::vector<std::size_t> free_;

  // Of the insertion at work.
  std::vector<std::size_t> cavity_;  // its slots
  std::vector<std::size_t> filled_;  // slots of the new tetrahedra, a wall each
  std::vector<Wall> walls_;
  static constexpr std::size_t few = 64;  // vertices of a cavity with a table of pairs
  std::vector<std::uint8_t> number_;      // [vertices] in `numbered_`, if that agrees
  std::array<Index, few> numbered_;
  std::size_t numbered_count_ = 0;
  std::vector<std::array<std::uint8_t, 4>> numbers_;  // [walls] those of the vertices
  std::array<Index, few * few> facets_;               // by the numbers of a directed edge
};

}  // namespace vorotool::core::tetrahedra
