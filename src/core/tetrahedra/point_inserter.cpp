#include "core/tetrahedra/point_inserter.hpp"

#include <algorithm>

#include "core/base/flat_map.hpp"

namespace vorotool::core::tetrahedra {

namespace {

// The other places of each place, an even permutation with it.
constexpr std::array<std::array<std::size_t, 3>, 4> others{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

}  // namespace

bool PointInserter::begin_at(std::size_t slot) {
  if (!mesh_.is_tetrahedron(slot) || !owns_slot(slot)) return false;
  last_ = slot;
  return is_placed_ = true;
}

bool PointInserter::insert(Index v) {
  const Point3& p = mesh_.point(v);
  if (!is_placed_ || !locate(p)) return false;
  if (!dig(p) || !reserve()) {
    for (const std::size_t slot : cavity_) mesh_.removed(slot) = 0;
    return false;
  }
  fill(v);
  if (walls_.size() / 2 + 2 <= few) {  // by Euler's relation, as many vertices
    link_few();
  } else {
    link_many();
  }
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
  cavity_.assign(1, slot);
  return true;
}

bool PointInserter::holds(std::size_t slot, const Point3& p) const {
  const auto point = [this](Index v) -> const Point3& { return mesh_.point(v); };
  const Row* row = &mesh_.row(slot);
  if ((*row)[3] == mesh_.infinity()) {
    const int side = mesh_.predicates().orient(point((*row)[0]), point((*row)[1]), point((*row)[2]), p);
    if (side != 0) return side > 0;
    slot = TetrahedralMesh::slot_of(mesh_.across(slot)[3]);
    if (mesh_.removed(slot) != 0) return true;
    row = &mesh_.row(slot);
  }
  const auto& [a, b, c, d] = *row;
  return mesh_.predicates().in_sphere(point(a), point(b), point(c), point(d), p) > 0;
}

// Marks what is removed, and lists the facets around it, whose outer sides must be of own slots.
bool PointInserter::dig(const Point3& p) {
  walls_.clear();
  mesh_.removed(cavity_[0]) = 1;
  for (std::size_t k = 0; k < cavity_.size(); ++k) {
    const std::size_t inner = cavity_[k];
    for (std::size_t i = 0; i < 4; ++i) {
      const Index outside = mesh_.across(inner)[i];
      const std::size_t outer = TetrahedralMesh::slot_of(outside);
      if (mesh_.removed(outer) != 0) continue;
      if (!owns_slot(outer)) return false;
      if (holds(outer, p)) {
        mesh_.removed(outer) = 1;
        cavity_.push_back(outer);
      } else {
        add_wall(inner, i, outside);
      }
    }
  }
  return true;
}

// An infinite vertex comes last.
void PointInserter::add_wall(std::size_t slot, std::size_t place, Index outside) {
  const Row& row = mesh_.row(slot);
  const auto [k, l, m] = others[place];
  Wall wall{row[k], row[l], row[m], outside};
  const Index infinity = mesh_.infinity();
  if (wall.a == infinity) wall = {wall.b, wall.c, wall.a, outside};
  if (wall.b == infinity) wall = {wall.c, wall.a, wall.b, outside};
  walls_.push_back(wall);
}

bool PointInserter::reserve() {
  while (cavity_.size() + free_.size() < walls_.size()) {
    if (!mesh_.take_slots(free_, is_alone_)) return false;
  }
  return true;
}

// A tetrahedron at each wall, with the new vertex as its first.
void PointInserter::fill(Index v) {
  filled_.clear();
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    std::size_t slot;
    if (w < cavity_.size()) {
      slot = cavity_[w];
    } else {
      slot = free_.back();
      free_.pop_back();
    }
    const Wall& wall = walls_[w];
    mesh_.removed(slot) = 0;
    mesh_.row(slot) = {v, wall.a, wall.b, wall.c};
    mesh_.link(TetrahedralMesh::facet(slot, 0), wall.outside);
    filled_.push_back(slot);
    if (wall.c != mesh_.infinity()) last_ = slot;
  }
  for (std::size_t k = walls_.size(); k < cavity_.size(); ++k) free_.push_back(cavity_[k]);
}

// A number below `few` for each vertex of the insertion: that which is at the vertex, if the list agrees.
std::size_t PointInserter::number_of(Index v) {
  if (v == mesh_.infinity()) return few - 1;
  std::uint8_t& number = numbers_[static_cast<std::size_t>(v)];
  if (number >= numbered_count_ || numbered_[number] != v) {
    number = static_cast<std::uint8_t>(numbered_count_);
    numbered_[numbered_count_++] = v;
  }
  return number;
}

// The walls are a sphere around the new vertex. Each edge of theirs is in two of them, in opposite directions: once
// all have left in a table which facet is beside it, each finds the other.
void PointInserter::link_few() {
  numbered_count_ = 0;
  edges_.resize(walls_.size());
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const std::size_t a = number_of(walls_[w].a), b = number_of(walls_[w].b), c = number_of(walls_[w].c);
    const Index facet = TetrahedralMesh::facet(filled_[w], 0);
    facets_[b * few + c] = facet + 1;
    facets_[c * few + a] = facet + 2;
    facets_[a * few + b] = facet + 3;
    edges_[w] = {c * few + b, a * few + c, b * few + a};
  }
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    Row& across = mesh_.across(filled_[w]);
    for (std::size_t k = 0; k < 3; ++k) across[k + 1] = facets_[edges_[w][k]];
  }
}

void PointInserter::link_many() {
  base::FlatMap facets(2 * walls_.size());
  const auto meet = [&](Index a, Index b, Index facet) {
    const auto [least, most] = std::minmax(a, b);
    std::uint64_t& other = facets[static_cast<std::uint64_t>(least) << 32 | static_cast<std::uint64_t>(most)];
    if (other == 0) {
      other = static_cast<std::uint64_t>(facet) + 1;
    } else {
      mesh_.link(facet, static_cast<Index>(other - 1));
    }
  };
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const Wall& wall = walls_[w];
    const Index facet = TetrahedralMesh::facet(filled_[w], 0);
    meet(wall.b, wall.c, facet + 1);
    meet(wall.c, wall.a, facet + 2);
    meet(wall.a, wall.b, facet + 3);
  }
}

}  // namespace vorotool::core::tetrahedra
