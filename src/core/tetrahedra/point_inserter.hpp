// Inserts points into a Delaunay triangulation of space.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/tetrahedra/tetrahedral_mesh.hpp"

namespace vorotool::core::tetrahedra {

// Removes all tetrahedra whose spheres hold the point, ties broken, and joins it to the facets around (A. Bowyer 1981,
// D. Watson 1981). A ghost is removed where the point is beyond its facet, or in the plane of that and in the sphere of
// the tetrahedron within: so no new one is flat, for whether a sphere holds a point in the plane of a facet depends on
// the facet alone, ties included.
//
// An inserter owns the vertices of an interval, which may go on from the last to the first of all, and the slots all of whose finite vertices it owns; it changes no
// others, and reads beside its own only neighbors of those. As these share vertices with its own, no inserter of
// another interval changes them: several may work at the same time, without locks.
class PointInserter {
 public:
  // `numbers` has a byte a point, which inserters share.
  PointInserter(TetrahedralMesh& mesh, std::span<std::uint8_t> numbers, std::size_t begin, std::size_t size)
      : mesh_(mesh),
        numbers_(numbers),
        begin_(static_cast<std::uint32_t>(begin)),
        size_(static_cast<std::uint32_t>(size)),
        is_alone_(size == mesh.points().size()) {}

  // Begins to search at a tetrahedron, if the inserter owns that.
  bool begin_at(std::size_t slot);
  // Inserts a point that it owns; false, and nothing is changed, where others own what would change.
  bool insert(Index v);
  // Slots that are left over, for another inserter.
  std::vector<std::size_t>& free() { return free_; }

 private:
  // A facet of the cavity, its vertices counter-clockwise seen from the new vertex, and the facet outside.
  struct Wall {
    Index a, b, c;
    Index outside;
  };

  bool owns(Index v) const {
    const auto number = static_cast<std::uint32_t>(v), around = static_cast<std::uint32_t>(mesh_.infinity());
    return (number < begin_ ? number + around : number) - begin_ < size_;
  }
  bool owns_slot(std::size_t slot) const {
    if (is_alone_) return true;
    const Row& row = mesh_.row(slot);
    return owns(row[0]) && owns(row[1]) && owns(row[2]) && (owns(row[3]) || row[3] == mesh_.infinity());
  }

  bool locate(const Point3& p);
  bool holds(std::size_t slot, const Point3& p) const;
  bool dig(const Point3& p);
  void add_wall(std::size_t slot, std::size_t place, Index outside);
  bool reserve();
  void fill(Index v);
  void link_few();
  void link_many();
  std::size_t number_of(Index v);

  TetrahedralMesh& mesh_;
  std::span<std::uint8_t> numbers_;
  const std::uint32_t begin_, size_;
  const bool is_alone_;
  std::size_t last_ = 0;  // where the next search begins: no ghost
  bool is_placed_ = false;
  std::vector<std::size_t> free_;

  // Of the insertion at work.
  std::vector<std::size_t> cavity_;  // its slots
  std::vector<Wall> walls_;
  std::vector<std::size_t> filled_;       // slots of the new tetrahedra, a wall each
  static constexpr std::size_t few = 64;  // vertices of a cavity with a table of pairs
  std::array<Index, few> numbered_;       // by the number that numbers_ has
  std::size_t numbered_count_ = 0;
  std::array<Index, few * few> facets_;            // by the numbers of a directed edge
  std::vector<std::array<std::size_t, 3>> edges_;  // [walls] where the edges are in that table
};

}  // namespace vorotool::core::tetrahedra
