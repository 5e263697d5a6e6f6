#include "core/tetrahedra/point_inserter.hpp"

#include <algorithm>
#include <bit>

#include "core/base/flat_map.hpp"

namespace vorotool::core::tetrahedra {

namespace {

// The other places of each place, an even permutation with it; the last one is last unless it is the place.
constexpr std::array<std::array<std::size_t, 3>, 4> others{{{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}}};

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
  drop_inner_sides();
  if (!reserve()) {
    undo();
    return false;
  }
  fill(v);
  return true;
}

// What is across the first of some facets that the inserter owns, or -1.
Index PointInserter::way_out(std::size_t slot, unsigned facets) const {
  for (; facets != 0; facets &= facets - 1) {
    const Index next = mesh_.across(slot)[static_cast<std::size_t>(std::countr_zero(facets))];
    if (owns_slot(TetrahedralMesh::slot_of(next))) return next;
  }
  return -1;
}

// A visibility walk to `last_`, which may be a ghost in the end. It ends, as the simplices of a lower hull are in an
// acyclic order seen from any point (H. Edelsbrunner, "An acyclicity theorem for cell complexes in d dimensions", 1990).
bool PointInserter::locate(const Point3& p) {
  const auto point = [this](Index v) { return &mesh_.point(v); };
  std::size_t slot = last_;
  for (unsigned asked = 15; !mesh_.is_ghost(slot);) {
    const auto& [a, b, c, d] = mesh_.row(slot);
    const unsigned beyond = mesh_.predicates().beyond({point(a), point(b), point(c), point(d)}, p, asked);
    if (beyond == 0) break;
    last_ = slot;
    const Index next = way_out(slot, beyond);
    if (next < 0) return false;
    slot = TetrahedralMesh::slot_of(next);
    asked = 15U & ~(1U << TetrahedralMesh::place_of(next));
  }
  cavity_.size = 0;
  *cavity_.room(1) = TetrahedralMesh::facet(slot, 0);
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

// Lists the neighbors of slots of the cavity that were not seen before.
void PointInserter::look_around(std::size_t begin, std::size_t end) {
  Index* sides = sides_.room(4 * (end - begin));
  Index* seen = seen_.room(4 * (end - begin));
  const Index* const cavity = cavity_.items.data();
  Mark* const marks = mesh_.marks();
  const Tetrahedron* const tetrahedra = mesh_.tetrahedra();
  for (std::size_t k = begin; k < end; ++k) {
    const auto from = static_cast<std::uint32_t>(cavity[k]);
    const Row& across = tetrahedra[from / 4].across;
    for (std::uint32_t turn = k == 0 ? 0 : 1; turn < 4; ++turn) {
      const Index outside = across[(from + turn) % 4];
      Mark& mark = marks[TetrahedralMesh::slot_of(outside)];
      const auto bits = static_cast<unsigned>(mark);
      *sides = *seen = outside;
      sides += (bits >> 1) ^ 1;
      seen += (bits & 1) ^ 1;
      mark = static_cast<Mark>(bits | 1);
    }
  }
  sides_.end_at(sides);
  seen_.end_at(seen);
}

// Marks what is removed; false where others own some of it.
bool PointInserter::dig(const Point3& p) {
  seen_.size = sides_.size = 0;
  mesh_.mark(TetrahedralMesh::slot_of(cavity_[0])) = Mark::removed;
  std::size_t looked = 0, tested = 0;
  do {
    const std::size_t end = cavity_.size;
    for (std::size_t k = looked; k < end; ++k) {
      if (!owns_slot(TetrahedralMesh::slot_of(cavity_[k]))) return false;
    }
    look_around(looked, end);
    looked = end;
    for (; tested < seen_.size; tested += lanes) test(tested, std::min(lanes, seen_.size - tested), p);
    tested = seen_.size;
  } while (looked < cavity_.size);
  return true;
}

// Decides which of at most four slots are in the cavity.
void PointInserter::test(std::size_t begin, std::size_t count, const Point3& p) {
  Index* end = seen_.room(lanes);
  for (std::size_t k = count; k < lanes; ++k)
    *end++ = seen_[begin];  // what more there is to test changes nothing
  const Index* const seen = &seen_[begin];
  const SphereSides sides =
      batch_(mesh_.points().data(), mesh_.records(), seen, p, mesh_.predicates().sphere_bound());
  unsigned inside = sides.inside;
  const unsigned all = (1U << count) - 1;
  for (unsigned unsure = ~(sides.inside | sides.outside) & all; unsure != 0; unsure &= unsure - 1) {
    const int k = std::countr_zero(unsure);
    inside |= static_cast<unsigned>(holds(TetrahedralMesh::slot_of(seen[k]), p)) << k;
  }
  Index* cavity = cavity_.room(lanes);
  Mark* const marks = mesh_.marks();
  inside &= all;
  for (std::size_t k = lanes; k-- > 0;) {  // what is tested twice gets its mark in the end
    const unsigned is_inside = inside >> k & 1;
    marks[TetrahedralMesh::slot_of(seen[k])] = static_cast<Mark>(1 | is_inside << 1);
    *cavity = seen[k];
    cavity += is_inside;
  }
  cavity_.end_at(cavity);
}

void PointInserter::undo() {
  mesh_.mark(TetrahedralMesh::slot_of(cavity_[0])) = Mark::live;
  for (const Index facet : seen_.all()) mesh_.mark(TetrahedralMesh::slot_of(facet)) = Mark::live;
}

// Of the sides those that are around the cavity in the end stay.
void PointInserter::drop_inner_sides() {
  const Mark* const marks = mesh_.marks();
  Index* outsides = sides_.items.data();
  for (const Index outside : sides_.all()) {
    *outsides = outside;
    outsides += marks[TetrahedralMesh::slot_of(outside)] != Mark::removed;
  }
  sides_.end_at(outsides);
}

bool PointInserter::reserve() {
  while (cavity_.size + free_.size() < sides_.size) {
    if (!mesh_.take_slots(free_, is_alone_)) return false;
  }
  return true;
}

// A tetrahedron at each wall, with the new vertex as its first.
void PointInserter::fill(Index v) {
  undo();
  while (cavity_.size > sides_.size) {
    const std::size_t slot = TetrahedralMesh::slot_of(cavity_[--cavity_.size]);
    mesh_.mark(slot) = Mark::removed;
    free_.push_back(slot);
  }
  Index* facets = cavity_.room(sides_.size - cavity_.size);
  for (; cavity_.size < sides_.size; ++cavity_.size, free_.pop_back()) {
    mesh_.mark(free_.back()) = Mark::live;
    *facets++ = TetrahedralMesh::facet(free_.back(), 0);
  }
  list_walls();
  const bool are_few = walls_.size / 2 + 2 <= few;  // by Euler's relation, as many vertices
  if (are_few) number_edges();
  Tetrahedron* const tetrahedra = mesh_.tetrahedra();
  const Index infinity = mesh_.infinity();
  const Index* cavity = cavity_.items.data();
  std::size_t last = last_;
  for (const Wall& wall : walls_.all()) {
    const Index facet = TetrahedralMesh::first_facet(*cavity++);
    const std::size_t slot = TetrahedralMesh::slot_of(facet);
    const auto& [a, b, c] = wall.edges;
    tetrahedra[slot] = {{v, wall.a, wall.b, wall.c}, {wall.outside, facets_[a], facets_[b], facets_[c]}};
    tetrahedra[TetrahedralMesh::slot_of(wall.outside)].across[TetrahedralMesh::place_of(wall.outside)] =
        facet;
    last = wall.c != infinity ? slot : last;
  }
  last_ = last;
  notes_.slots[static_cast<std::size_t>(v)] = static_cast<std::uint32_t>(last_);
  if (!are_few) link_many();
}

void PointInserter::list_walls() {
  walls_.size = 0;
  Wall* wall = walls_.room(sides_.size);
  walls_.size = sides_.size;
  const Tetrahedron* const tetrahedra = mesh_.tetrahedra();
  for (const Index outside : sides_.all()) {
    const Index inside =
        tetrahedra[TetrahedralMesh::slot_of(outside)].across[TetrahedralMesh::place_of(outside)];
    const Row& row = tetrahedra[TetrahedralMesh::slot_of(inside)].vertices;
    const auto& [k, l, m] = others[TetrahedralMesh::place_of(inside)];
    wall->a = row[k], wall->b = row[l], wall->c = row[m], wall->outside = outside;
    ++wall;
  }
}

// The walls are a sphere around the new vertex. Each edge of theirs is in two of them, in opposite directions: once
// all have left in a table which facet is beside it, each finds the other. Its vertices are numbered below `few` for
// that, while it lasts.
void PointInserter::number_edges() {
  const auto byte_of = notes_.numbers.data();
  const Index infinity = mesh_.infinity();
  constexpr std::uint32_t side = few, infinite = few - 1;
  std::array<Index, few + 1> vertices;
  std::uint32_t count = 0;
  const auto number_of = [&](Index v) {
    const std::uint32_t known = byte_of[v], number = known == unnumbered ? count : known;
    byte_of[v] = static_cast<std::uint8_t>(number);
    vertices[count] = v;
    count += known == unnumbered;
    return number;
  };
  const Index* cavity = cavity_.items.data();
  Index* const facets = facets_.data();
  Wall* const end = walls_.items.data() + walls_.size;
  for (Wall* wall = walls_.items.data(); wall != end; ++wall) {
    const std::uint32_t a = number_of(wall->a), b = number_of(wall->b);
    const std::uint32_t c = wall->c == infinity ? infinite : number_of(wall->c);
    const Index facet = TetrahedralMesh::first_facet(*cavity++);
    facets[b * side + c] = facet + 1;
    facets[c * side + a] = facet + 2;
    facets[a * side + b] = facet + 3;
    wall->edges = {c * side + b, a * side + c, b * side + a};
  }
  for (std::uint32_t k = 0; k < count; ++k) byte_of[vertices[k]] = unnumbered;
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
    const Index facet = TetrahedralMesh::first_facet(cavity_[w]);
    meet(wall.b, wall.c, facet + 1);
    meet(wall.c, wall.a, facet + 2);
    meet(wall.a, wall.b, facet + 3);
  }
}

}  // namespace vorotool::core::tetrahedra
