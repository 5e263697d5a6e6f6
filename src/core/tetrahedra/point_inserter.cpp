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
    for (std::size_t i = 0; i < 4 && out == 4; ++i) {
      if (i == from) continue;
      const auto [k, l, m] = facet_vertices[i];
      const Point3 &a = mesh_.point(row[k]), &b = mesh_.point(row[l]), &c = mesh_.point(row[m]);
      if (mesh_.predicates().orient(a, b, c, p) < 0) out = i;
    }
    if (out == 4) break;
    last_ = slot;
    const Index next = mesh_.across(slot)[out];
    slot = TetrahedralMesh::slot_of(next);
    from = TetrahedralMesh::place_of(next);
    if (!owns_slot(slot)) return false;
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

// Marks what is removed; false where that is not known without slots of others.
bool PointInserter::dig(const Point3& p) {
  seen_.size = sides_.size = 0;
  mesh_.mark(cavity_[0]) = Mark::removed;
  std::size_t looked = 0, tested = 0;
  do {
    const std::size_t count = std::min(lanes, seen_.size - tested);
    if (count > 0) test(tested, count, p);
    tested += count;
    while (looked < cavity_.size && seen_.size - tested < lanes) {
      if (!look_around(cavity_[looked++])) return false;
    }
  } while (tested < seen_.size);
  return true;
}

// Lists the neighbors of a slot that were not seen before.
bool PointInserter::look_around(std::size_t inner) {
  Sides* sides = sides_.room(4);
  std::uint32_t* seen = seen_.room(4);
  const Row& across = mesh_.across(inner);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t outer = TetrahedralMesh::slot_of(across[i]);
    Mark& mark = mesh_.mark(outer);
    const bool is_new = mark == Mark::live, is_removed = mark == Mark::removed;
    if (!is_alone_ && is_new && !owns_slot(outer)) return false;
    *sides = {TetrahedralMesh::facet(inner, i), across[i]};
    sides += !is_removed;
    *seen = static_cast<std::uint32_t>(outer);
    seen += is_new;
    mark = is_removed ? Mark::removed : Mark::seen;
    seen_.size += is_new;
  }
  sides_.size = static_cast<std::size_t>(sides - sides_.items.data());
  return true;
}

// Decides which of some slots are in the cavity.
void PointInserter::test(std::size_t begin, std::size_t count, const Point3& p) {
  const int* rows[lanes];
  unsigned ghosts = 0;
  for (std::size_t k = 0; k < lanes; ++k) {
    const Row& row = mesh_.row(seen_[begin + std::min(k, count - 1)]);
    rows[k] = row.data();
    ghosts |= static_cast<unsigned>(row[3] == mesh_.infinity()) << k;
  }
  const SphereSides sides = batch_(mesh_.points().data(), rows, p, mesh_.predicates().sphere_bound());
  const unsigned all = (1U << count) - 1;
  unsigned inside = sides.inside;
  for (unsigned unsure = (ghosts | ~(sides.inside | sides.outside)) & all; unsure != 0;
       unsure &= unsure - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(unsure));
    const unsigned is_inside = holds(seen_[begin + k], p);
    inside = (inside & ~(1U << k)) | is_inside << k;
  }
  std::uint32_t* cavity = cavity_.room(lanes);
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t slot = seen_[begin + k];
    const bool is_inside = (inside >> k & 1) != 0;
    mesh_.mark(slot) = is_inside ? Mark::removed : Mark::seen;
    *cavity = slot;
    cavity += is_inside;
  }
  cavity_.size = static_cast<std::size_t>(cavity - cavity_.items.data());
}

void PointInserter::undo() {
  mesh_.mark(cavity_[0]) = Mark::live;
  for (const std::uint32_t slot : seen_.all()) mesh_.mark(slot) = Mark::live;
}

void PointInserter::list_walls() {
  walls_.size = 0;
  Wall* wall = walls_.room(sides_.size + 1);
  for (const auto [inside, outside] : sides_.all()) {
    const Row& row = mesh_.row(TetrahedralMesh::slot_of(inside));
    const auto& [k, l, m] = others[TetrahedralMesh::place_of(inside)];
    wall->a = row[k], wall->b = row[l], wall->c = row[m];
    wall->outside = outside;
    wall += mesh_.mark(TetrahedralMesh::slot_of(outside)) != Mark::removed;
  }
  walls_.size = static_cast<std::size_t>(wall - walls_.items.data());
}

bool PointInserter::reserve() {
  while (cavity_.size + free_.size() < walls_.size) {
    if (!mesh_.take_slots(free_, is_alone_)) return false;
  }
  return true;
}

// A tetrahedron at each wall, with the new vertex as its first.
void PointInserter::fill(Index v) {
  for (const std::uint32_t slot : seen_.all()) {
    Mark& mark = mesh_.mark(slot);
    mark = mark == Mark::removed ? Mark::removed : Mark::live;
  }
  for (std::size_t w = 0; w < walls_.size; ++w) {
    Wall& wall = walls_[w];
    if (w < cavity_.size) {
      wall.slot = cavity_[w];
    } else {
      wall.slot = static_cast<std::uint32_t>(free_.back());
      free_.pop_back();
    }
    mesh_.mark(wall.slot) = Mark::live;
    mesh_.row(wall.slot) = {v, wall.a, wall.b, wall.c};
    mesh_.link(TetrahedralMesh::facet(wall.slot, 0), wall.outside);
    if (wall.c != mesh_.infinity()) last_ = wall.slot;
  }
  for (std::size_t k = walls_.size; k < cavity_.size; ++k) free_.push_back(cavity_[k]);
  if (walls_.size / 2 + 2 <= few) {  // by Euler's relation, as many vertices
    link_few();
  } else {
    link_many();
  }
}

// A number below `few` for each vertex of the insertion: that which is at the vertex, if the list agrees.
std::size_t PointInserter::number_of(Index v) {
  if (v == mesh_.infinity()) return few - 1;
  std::uint8_t& at_vertex = numbers_[static_cast<std::size_t>(v)];
  const std::size_t known = at_vertex;
  const bool is_new = (known >= numbered_count_) | (numbered_[known] != v);
  const std::size_t number = is_new ? numbered_count_ : known;
  at_vertex = static_cast<std::uint8_t>(number);
  numbered_[number] = v;
  numbered_count_ += is_new;
  return number;
}

// The walls are a sphere around the new vertex. Each edge of theirs is in two of them, in opposite directions: once
// all have left in a table which facet is beside it, each finds the other.
void PointInserter::link_few() {
  numbered_count_ = 0;
  const auto edge = [](std::size_t from, std::size_t to) {
    return static_cast<std::uint16_t>(from * few + to);
  };
  for (std::size_t w = 0; w < walls_.size; ++w) {
    Wall& wall = walls_[w];
    const std::size_t a = number_of(wall.a), b = number_of(wall.b), c = number_of(wall.c);
    const Index facet = TetrahedralMesh::facet(wall.slot, 0);
    facets_[edge(b, c)] = facet + 1;
    facets_[edge(c, a)] = facet + 2;
    facets_[edge(a, b)] = facet + 3;
    wall.edges = {edge(c, b), edge(a, c), edge(b, a)};
  }
  for (const Wall& wall : walls_.all()) {
    Row& across = mesh_.across(wall.slot);
    for (std::size_t k = 0; k < 3; ++k) across[k + 1] = facets_[wall.edges[k]];
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
  for (const Wall& wall : walls_.all()) {
    const Index facet = TetrahedralMesh::facet(wall.slot, 0);
    meet(wall.b, wall.c, facet + 1);
    meet(wall.c, wall.a, facet + 2);
    meet(wall.a, wall.b, facet + 3);
  }
}

}  // namespace vorotool::core::tetrahedra
