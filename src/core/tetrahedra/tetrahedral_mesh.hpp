// A triangulation of space that grows point by point.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/tetrahedra/set_predicates.hpp"

namespace vorotool::core::tetrahedra {

using Index = std::int32_t;
using Row = std::array<Index, 4>;

// There is no memory for as many tetrahedra as points have, or they are more than 2^29.
struct TooManyTetrahedra : std::length_error {
  explicit TooManyTetrahedra(std::size_t tetrahedra)
      : std::length_error(std::to_string(tetrahedra)) {}  // so far
};

// The vertices of each facet: with what lies on its inner side they are a positive tetrahedron.
inline constexpr std::array<std::array<std::size_t, 3>, 4> facet_vertices{
    {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

// Four vertices, positive in their order, and four facets across, each opposite to a vertex. Half a line of the cache.
struct alignas(32) Tetrahedron {
  Row vertices, across;
};
static_assert(sizeof(Tetrahedron) == 8 * sizeof(Index));

// What a slot holds: a tetrahedron; one that is looked at; none, or one that is about to be removed. The first bit tells
// what is looked at, the second one what is removed.
enum class Mark : std::uint8_t { live = 0, seen = 1, removed = 3 };

// Tetrahedra lie in slots; their facets are numbered 4 slot + place. A facet of the hull has a ghost beyond it, whose last vertex is infinite; its
// three others are counter-clockwise seen from outside. Several threads may change slots that they do not share.
class TetrahedralMesh {
 public:
  // Distinct points, and behind their end that at infinity, whose coordinates are NaN: no filter tells anything of it.
  TetrahedralMesh(std::span<const Point3> points, const SetPredicates& predicates);

  // The first tetrahedron, of vertices that are not coplanar.
  void start(Row vertices);

  // Adds free slots to a list; false where the arrays are full, unless they may grow, which no other thread must see.
  // Throws TooManyTetrahedra where there would be more than 2^29 slots, as facets have 31 bits, or than memory holds.
  bool take_slots(std::vector<std::size_t>& free, bool may_grow);

  std::size_t slots() const { return slots_; }
  std::span<const Point3> points() const { return points_; }
  const Point3& point(Index v) const { return points_[static_cast<std::size_t>(v)]; }
  const SetPredicates& predicates() const { return predicates_; }
  Index infinity() const { return infinity_; }
  bool is_ghost(std::size_t slot) const { return row(slot)[3] == infinity_; }
  bool is_tetrahedron(std::size_t slot) const { return marks_[slot] == Mark::live && !is_ghost(slot); }

  static std::size_t slot_of(Index facet) { return static_cast<std::uint32_t>(facet) / 4; }
  static std::size_t place_of(Index facet) { return static_cast<std::uint32_t>(facet) % 4; }
  static Index facet(std::size_t slot, std::size_t place) { return static_cast<Index>(4 * slot + place); }
  static Index first_facet(Index facet) { return facet & ~3; }  // of the same slot
  void link(Index a, Index b) {
    across(slot_of(a))[place_of(a)] = b;
    across(slot_of(b))[place_of(b)] = a;
  }

  // Of each slot four vertices and four facets.
  const Index (*records() const)[8] { return reinterpret_cast<const Index(*)[8]>(tetrahedra_.data()); }
  Tetrahedron* tetrahedra() { return tetrahedra_.data(); }
  Tetrahedron& tetrahedron(std::size_t slot) { return tetrahedra_[slot]; }
  Row& row(std::size_t slot) { return tetrahedra_[slot].vertices; }
  const Row& row(std::size_t slot) const { return tetrahedra_[slot].vertices; }
  Row& across(std::size_t slot) { return tetrahedra_[slot].across; }
  const Row& across(std::size_t slot) const { return tetrahedra_[slot].across; }
  Mark* marks() { return marks_.data(); }
  Mark& mark(std::size_t slot) { return marks_[slot]; }
  Mark mark(std::size_t slot) const { return marks_[slot]; }

  base::LargeArray<Tetrahedron> take_tetrahedra() { return std::move(tetrahedra_); }
  void drop_marks() { marks_ = {}; }

 private:
  void grow();
  std::size_t whole_pieces(std::size_t slots) const;

  std::span<const Point3> points_;
  const SetPredicates& predicates_;
  const Index infinity_;
  const std::size_t slots_at_once_;
  std::size_t slots_ = 0;
  std::mutex growing_;  // guards the number of slots
  base::LargeArray<Tetrahedron> tetrahedra_;
  base::LargeArray<Mark> marks_;
};

}  // namespace vorotool::core::tetrahedra
