// Inserts points into a Delaunay triangulation of space.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/tetrahedra/sphere_batch.hpp"
#include "core/tetrahedra/tetrahedral_mesh.hpp"

namespace vorotool::core::tetrahedra {

// Removes all tetrahedra whose spheres hold the point, ties broken, and joins it to the facets around (A. Bowyer 1981,
// D. Watson 1981). A ghost is removed where the point is beyond its facet, or in the plane of that and in the sphere of
// the tetrahedron within: so no new one is flat, for whether a sphere holds a point in the plane of a facet depends on
// the facet alone, ties included.
//
// An inserter owns the vertices of an interval, which may go on from the last to the first of all, and the slots all of
// whose finite vertices it owns. Beside those it looks at, marks and links only their neighbors, which have at most one
// vertex that another owns: so that they are neither slots nor neighbors of another's. Several inserters may work at the
// same time, without locks.
class PointInserter {
 public:
  // What inserters share, of each point: its number among those of a cavity, at other times none, and a slot that it
  // once was in. As slots are filled again with what is there then, that is still near it.
  struct Notes {
    std::span<std::uint8_t> numbers;
    std::span<std::uint32_t> slots;
  };
  static constexpr std::uint8_t unnumbered = 255;

  PointInserter(TetrahedralMesh& mesh, const Notes& notes, std::size_t begin, std::size_t size)
      : mesh_(mesh),
        notes_(notes),
        begin_(static_cast<std::uint32_t>(begin)),
        size_(static_cast<std::uint32_t>(size)),
        is_alone_(size == mesh.points().size()),
        batch_(sphere_batch()) {}

  // Begins to search at a tetrahedron, if the inserter owns that.
  bool begin_at(std::size_t slot);
  // Inserts a point that it owns; false, and nothing is changed, where others own what would change.
  bool insert(Index v);
  // Slots that are left over, for another inserter.
  std::vector<std::size_t>& free() { return free_; }

 private:
  // A list to whose end items are written before it is known whether they stay: no branch is mispredicted.
  template <class T>
  struct List {
    std::vector<T> items;
    std::size_t size = 0;

    // The end, with room for so many more; and a new end.
    T* room(std::size_t more) {
      if (items.size() < size + more) items.resize(2 * (size + more));
      return items.data() + size;
    }
    void end_at(const T* end) { size = static_cast<std::size_t>(end - items.data()); }
    const T& operator[](std::size_t k) const { return items[k]; }
    std::span<const T> all() const { return {items.data(), size}; }
  };

  // A facet of the cavity: its vertices, counter-clockwise seen from the new vertex, an infinite one last; the facet
  // outside; and where its three edges are in the table of pairs.
  struct Wall {
    Index a, b, c;
    Index outside;
    std::array<std::uint32_t, 3> edges;
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

  Index way_out(std::size_t slot, unsigned facets) const;
  bool locate(const Point3& p);
  bool holds(std::size_t slot, const Point3& p) const;
  bool dig(const Point3& p);
  void look_around(std::size_t begin, std::size_t end);
  void test(std::size_t begin, std::size_t count, const Point3& p);
  void undo();
  void drop_inner_sides();
  bool reserve();
  void fill(Index v);
  void list_walls();
  void number_edges();
  void link_many();

  TetrahedralMesh& mesh_;
  const Notes notes_;
  const std::uint32_t begin_, size_;
  const bool is_alone_;
  const SphereBatch batch_;
  std::size_t last_ = 0;  // where the next search begins: no ghost
  bool is_placed_ = false;
  std::vector<std::size_t> free_;

  // Of the insertion at work.
  List<Index> cavity_;  // facets of its slots: that to the slot from which it was seen, but of the first
  List<Index> seen_;    // the same of slots around those, in the cavity or not
  List<Index>
      sides_;  // facets around the cavity, seen from outside; at first of slots not yet known to be in it
  List<Wall> walls_;
  static constexpr std::size_t few = 64;   // vertices of a cavity with a table of pairs
  std::array<Index, few * few> facets_{};  // by the numbers of a directed edge
};

}  // namespace vorotool::core::tetrahedra
