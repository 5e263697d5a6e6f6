#include "core/tetrahedra/point_inserter.hpp"

#include <algorithm>
#include <bit>

#include "core/base/flat_map.hpp"

namespace vorotool::core::tetrahedra {

namespace {

// The other places of each place, an even permutation with it; the last one is last unless it is the place.
constexpr std::array<std::array<std::size_t, 3>, 4> others{{{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}}};

constexpr std::uint8_t unnumbered = 255;
constexpr std::size_t lanes = 4;  // tetrahedra that are tested together

}  // namespace

bool PointInserter::begin_at(std::size_t slot) {
  if (!mesh_.is_tetrahedron(slot) || !owns_slot(slot)) return false;
  last_ = slot;
  return is_placed_ = true;
}

bool PointInserter::insert(Index v) {
  const Point3& p = mesh_.point(v);
  if (!is_placed_ || !locate(p)) return false;
  if (!dig(p)) {
    undo();
    return false;
  }
  list_walls();
  if (!reserve()) {
    undo();
    return false;
  }
  fill(v);
  return true;
}

// A visibility walk to `last_`, which may be a ghost in the end. It ends, as the simplices of a lower hull are in an
// acyclic order seen from any point (H. Edelsbrunner, "An acyclicity theorem for cell complexes in d dimensions", 1990).
bool PointInserter::locate(const Point3& p) {
  std::size_t slot = last_, from = 4;
  while (!mesh_.is_ghost(slot)) {
    const Row& row = mesh_.row(slot);
    std::size_t out = 4;
    bool is_beyond = false;
    for (std::size_t i = 0; i < 4 && out == 4; ++i) {
      if (i == from) continue;
      const auto [k, l, m] = facet_vertices[i];
      const Point3 &a = mesh_.point(row[k]), &b = mesh_.point(row[l]), &c = mesh_.point(row[m]);
      if (mesh_.predicates().orient(a, b, c, p) >= 0) continue;
      if (owns_slot(TetrahedralMesh::slot_of(mesh_.across(slot)[i]))) out = i;
      is_beyond = true;
    }
    if (out == 4 && is_beyond) return false;
    if (out == 4) break;
    last_ = slot;
    const Index next = mesh_.across(slot)[out];
    slot = TetrahedralMesh::slot_of(next);
    from = TetrahedralMesh::place_of(next);
  }
  cavity_.size = 0;
  *cavity_.room(1) = static_cast<std::uint32_t>(slot);
  cavity_.size = 1;
  return true;
}

// Where the filter cannot tell, or the tetrahedron is a ghost.
bool PointInserter::holds(std::size_t slot, const Point3& p) const {
  const auto point = [this](Index v) -> const Point3& { return mesh_.point(v); };
  if (mesh_.is_ghost(slot)) {
    const auto& [a, b, c, infinite] = mesh_.row(slot);
    const int side = mesh_.predicates().orient(point(a), point(b), point(c), p);
    if (side != 0) return side > 0;
    slot = TetrahedralMesh::slot_of(mesh_.across(slot)[3]);
    if (mesh_.mark(slot) == Mark::removed) return true;
  }
  const auto& [a, b, c, d] = mesh_.row(slot);
  return mesh_.predicates().in_sphere(point(a), point(b), point(c), point(d), p) > 0;
}

// Lists the neighbors of a slot that were not seen before.
void PointInserter::look_around(std::size_t inner) {
  Sides* sides = sides_.room(4);
  std::uint32_t* seen = seen_.room(4);
  const Row across = mesh_.across(inner);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t outer = TetrahedralMesh::slot_of(across[i]);
    Mark& mark = mesh_.mark(outer);
    const bool is_new = mark == Mark::live, is_removed = mark == Mark::removed;
    *sides = {TetrahedralMesh::facet(inner, i), across[i]};
    sides += !is_removed;
    *seen = static_cast<std::uint32_t>(outer);
    seen += is_new;
    mark = is_removed ? Mark::removed : Mark::seen;
  }
  sides_.end_at(sides);
  seen_.end_at(seen);
}

// Marks what is removed; false where others own some of it.
bool PointInserter::dig(const Point3& p) {
  seen_.size = sides_.size = 0;
  mesh_.mark(cavity_[0]) = Mark::removed;
  std::size_t looked = 0, tested = 0;
  do {
    for (const std::size_t end = cavity_.size; looked < end; ++looked) {
      if (!owns_slot(cavity_[looked])) return false;
      look_around(cavity_[looked]);
    }
    for (const std::size_t end = seen_.size; tested < end; tested += lanes)
      test(tested, std::min(lanes, end - tested), p);
    tested = seen_.size;
  } while (looked < cavity_.size);
  return true;
}

// Decides which of at most four slots are in the cavity.
void PointInserter::test(std::size_t begin, std::size_t count, const Point3& p) {
  std::uint32_t* end = seen_.room(lanes);
  for (std::size_t k = count; k < lanes; ++k)
    *end++ = seen_[begin];  // what more there is to test changes nothing
  const std::uint32_t* slots = &seen_[begin];
  const SphereSides sides =
      batch_(mesh_.points().data(), mesh_.records(), slots, p, mesh_.predicates().sphere_bound());
  unsigned inside = sides.inside;
  const unsigned all = (1U << count) - 1;
  for (unsigned unsure = ~(sides.inside | sides.outside) & all; unsure != 0; unsure &= unsure - 1) {
    const int k = std::countr_zero(unsure);
    inside |= static_cast<unsigned>(holds(slots[k], p)) << k;
  }
  std::uint32_t* cavity = cavity_.room(lanes);
  for (std::size_t k = 0; k < count; ++k) {
    const bool is_inside = (inside >> k & 1) != 0;
    mesh_.mark(slots[k]) = is_inside ? Mark::removed : Mark::seen;
    *cavity = slots[k];
    cavity += is_inside;
  }
  cavity_.end_at(cavity);
}

void PointInserter::undo() {
  mesh_.mark(cavity_[0]) = Mark::live;
  for (const std::uint32_t slot : seen_.all()) mesh_.mark(slot) = Mark::live;
}

void PointInserter::list_walls() {
  Sides* wall_sides = sides_.items.data();
  for (const Sides sides : sides_.all()) {
    *wall_sides = sides;
    wall_sides += mesh_.mark(TetrahedralMesh::slot_of(sides.outside)) != Mark::removed;
  }
  sides_.end_at(wall_sides);
  walls_.size = 0;
  Wall* wall = walls_.room(sides_.size);
  walls_.size = sides_.size;
  const Index infinity = mesh_.infinity();
  for (const auto [inside, outside] : sides_.all()) {
    const Row& row = mesh_.row(TetrahedralMesh::slot_of(inside));
    const auto& [k, l, m] = others[TetrahedralMesh::place_of(inside)];
    *wall++ = {row[k], row[l], row[m], outside, {}};
    for (const std::size_t place : {k, l, m}) {
      if (row[place] != infinity) notes_.numbers[static_cast<std::size_t>(row[place])] = unnumbered;
    }
  }
}

bool PointInserter::reserve() {
  while (cavity_.size + free_.size() < walls_.size) {
    if (!mesh_.take_slots(free_, is_alone_)) return false;
  }
  return true;
}

// A tetrahedron at each wall, with the new vertex as its first.
void PointInserter::fill(Index v) {
  for (const std::uint32_t slot : seen_.all()) mesh_.mark(slot) = Mark::live;
  mesh_.mark(cavity_[0]) = Mark::live;
  while (cavity_.size > walls_.size) {
    const std::uint32_t slot = cavity_[--cavity_.size];
    mesh_.mark(slot) = Mark::removed;
    free_.push_back(slot);
  }
  std::uint32_t* slots = cavity_.room(walls_.size - cavity_.size);
  for (; cavity_.size < walls_.size; ++cavity_.size, free_.pop_back()) {
    mesh_.mark(free_.back()) = Mark::live;
    *slots++ = static_cast<std::uint32_t>(free_.back());
  }
  const bool are_few = walls_.size / 2 + 2 <= few;  // by Euler's relation, as many vertices
  if (are_few) number_edges();
  for (std::size_t w = 0; w < walls_.size; ++w) {
    const Wall& wall = walls_[w];
    const std::size_t slot = cavity_[w];
    const Row beside =
        are_few ? Row{wall.outside, facets_[wall.edges[0]], facets_[wall.edges[1]], facets_[wall.edges[2]]}
                : Row{wall.outside, 0, 0, 0};
    mesh_.tetrahedron(slot) = {{v, wall.a, wall.b, wall.c}, beside};
    mesh_.across(TetrahedralMesh::slot_of(wall.outside))[TetrahedralMesh::place_of(wall.outside)] =
        TetrahedralMesh::facet(slot, 0);
    if (wall.c != mesh_.infinity()) last_ = slot;
  }
  notes_.slots[static_cast<std::size_t>(v)] = static_cast<std::uint32_t>(last_);
  if (!are_few) link_many();
}

// The walls are a sphere around the new vertex. Each edge of theirs is in two of them, in opposite directions: once
// all have left in a table which facet is beside it, each finds the other. Its vertices are numbered below `few` for
// that, in bytes which list_walls has cleared.
void PointInserter::number_edges() {
  const auto byte_of = notes_.numbers.data();
  const Index infinity = mesh_.infinity();
  constexpr std::uint32_t side = few, infinite = few - 1;
  std::uint32_t count = 0;
  const auto number_of = [&](Index v) {
    const std::uint32_t known = byte_of[v], number = known == unnumbered ? count : known;
    byte_of[v] = static_cast<std::uint8_t>(number);
    count += known == unnumbered;
    return number;
  };
  for (std::size_t w = 0; w < walls_.size; ++w) {
    Wall& wall = walls_.items[w];
    const std::uint32_t a = number_of(wall.a), b = number_of(wall.b);
    const std::uint32_t c = wall.c == infinity ? infinite : number_of(wall.c);
    const Index facet = TetrahedralMesh::facet(cavity_[w], 0);
    facets_[b * side + c] = facet + 1;
    facets_[c * side + a] = facet + 2;
    facets_[a * side + b] = facet + 3;
    wall.edges = {c * side + b, a * side + c, b * side + a};
  }
}

void PointInserter::link_many() {
  base::FlatMap facets(2 * walls_.size);
  const auto meet = [&](Index a, Index b, Index facet) {
    const auto [least, most] = std::minmax(a, b);
    std::uint64_t& other = facets[static_cast<std::uint64_t>(least) << 32 | static_cast<std::uint64_t>(most)];
    if (other == 0) {
      other = static_cast<std::uint64_t>(facet) + 1;
    } else {
      mesh_.link(facet, static_cast<Index>(other - 1));
    }
  };
  for (std::size_t w = 0; w < walls_.size; ++w) {
    const Wall& wall = walls_[w];
    const Index facet = TetrahedralMesh::facet(cavity_[w], 0);
    meet(wall.b, wall.c, facet + 1);
    meet(wall.c, wall.a, facet + 2);
    meet(wall.a, wall.b, facet + 3);
  }
}

}  // namespace vorotool::core::tetrahedra
