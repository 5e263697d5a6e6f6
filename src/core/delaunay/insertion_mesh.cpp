#include "core/delaunay/insertion_mesh.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace vorotool::core::delaunay {

using kernel::Point;

namespace {

[[noreturn]] void refuse() { throw std::invalid_argument("the triangles do not fit together"); }

}  // namespace

InsertionMesh::InsertionMesh(const TriangulationArrays& mesh, std::span<const Point> points, std::size_t more)
    : points_(points),
      slots_(mesh.triangles.size() / 3),
      corners_(3 * (slots_ + mesh.hull.size() + 2 * more)),
      across_(corners_.size()) {
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), corners_.data());
  std::copy(mesh.neighbors.begin(), mesh.neighbors.end(), across_.data());
  changed_.reserve(corners_.size() / 3);
  changed_.assign(slots_, 0);
  add_ghosts();
}

// Ghosts are linked to each other around the hull by the vertex that they share.
void InsertionMesh::add_ghosts() {
  const std::size_t sides = 3 * slots_;
  std::vector<std::pair<Vertex, Slot>> starts, ends;  // of hull sides, and their ghosts
  for (std::size_t i = 0; i < sides; ++i) {
    if (across_[i] >= 0) continue;
    const auto s = static_cast<Slot>(i / 3);
    const int k = static_cast<int>(i % 3);
    const Vertex a = corner(s, following(k)), b = corner(s, preceding(k));
    const Slot ghost = new_slot();
    set(ghost, {b, a, infinity});
    link(ghost, 2, s, k);
    starts.emplace_back(a, ghost);
    ends.emplace_back(b, ghost);
  }
  std::sort(starts.begin(), starts.end());
  std::sort(ends.begin(), ends.end());
  if (starts.empty()) refuse();
  for (std::size_t i = 0; i < starts.size(); ++i) {
    if (starts[i].first != ends[i].first || (i > 0 && starts[i].first == starts[i - 1].first)) refuse();
    link(starts[i].second, 0, ends[i].second, 1);
  }
}

InsertionMesh::Slot InsertionMesh::new_slot() {
  if (3 * slots_ == corners_.size()) refuse();  // more sides than the hull has
  const auto s = static_cast<Slot>(slots_++);
  changed_.push_back(0);
  mark(s);
  return s;
}

void InsertionMesh::mark(Slot s) {
  if (is_changed(s)) return;
  changed_[static_cast<std::size_t>(s)] = 1;
  changed_slots_.push_back(s);
}

void InsertionMesh::set(Slot s, const std::array<Vertex, 3>& corners) {
  std::copy(corners.begin(), corners.end(), corners_.data() + at(s, 0));
  mark(s);
}

void InsertionMesh::link(Slot s, int k, Slot t, int j) {
  across_[at(s, k)] = t;
  across_[at(t, j)] = s;
}

int InsertionMesh::corner_of(Slot s, Vertex v) const {
  for (int k = 0; k < 3; ++k) {
    if (corner(s, k) == v) return k;
  }
  refuse();
}

int InsertionMesh::side_towards(Slot s, Slot t) const {
  for (int k = 0; k < 3; ++k) {
    if (across(s, k) == t) return k;
  }
  refuse();
}

void InsertionMesh::rotate(Slot s, int k) {
  for (std::int32_t* of : {corners_.data() + at(s, 0), across_.data() + at(s, 0)})
    std::rotate(of, of + k, of + 3);
}

// The search.

// A visibility walk: from each triangle across a side that has the point on its other side. It ends in a
// Delaunay triangulation: with every step the power of the point with respect to the triangle's circle
// decreases (L. De Floriani and others, "On sorting triangles in a Delaunay tessellation", Algorithmica 6,
// 1991), or, across a side between cocircular triangles, stays, where a walk among the triangles of a convex
// polygon cannot turn in a circle. Orientations are exact, so no triangle is met twice, and a walk longer
// than all is one of no triangulation.
InsertionMesh::Location InsertionMesh::locate(const Point& p, Slot start) const {
  Slot s = is_ghost(start) ? across(start, corner_of(start, infinity)) : start;
  Slot before = -1;
  for (std::size_t steps = 0; steps < slots(); ++steps) {
    int out = -1, on = -1, zeros = 0;
    for (int k = 0; k < 3 && out < 0; ++k) {
      if (across(s, k) == before) continue;
      const int side = kernel::orient2d(point(corner(s, following(k))), point(corner(s, preceding(k))), p);
      if (side < 0) out = k;
      if (side == 0) on = zeros++ == 0 ? k : 3 - on - k;  // with two sides, the corner where they meet
    }
    if (out < 0) return {s, zeros == 0 ? Place::face : zeros == 1 ? Place::side : Place::vertex, on};
    before = s;
    s = across(s, out);
    if (is_ghost(s)) return {s, Place::face, -1};
  }
  refuse();
}

// Insertion.

InsertionMesh::Vertex InsertionMesh::insert(Vertex v, Slot& near) {
  const Location found = locate(point(v), near);
  near = found.slot;
  if (found.place == Place::vertex) return corner(found.slot, found.k);
  if (found.place == Place::face) {
    insert_in_face(v, found.slot);
  } else {
    insert_on_side(v, found.slot, found.k);
  }
  legalize();
  return v;
}

void InsertionMesh::insert_in_face(Vertex v, Slot s) {
  const std::array<Vertex, 3> c{corner(s, 0), corner(s, 1), corner(s, 2)};
  const std::array<Slot, 3> outside{across(s, 0), across(s, 1), across(s, 2)};
  std::array<int, 3> back{};
  for (std::size_t k = 0; k < 3; ++k) back[k] = side_towards(outside[k], s);
  const std::array<Slot, 3> part{s, new_slot(), new_slot()};
  for (std::size_t k = 0; k < 3; ++k) {  // part k has the side opposite to corner k
    set(part[k], {c[following(k)], c[preceding(k)], v});
    link(part[k], 2, outside[k], back[k]);
    pending_.push_back(part[k]);
  }
  for (std::size_t k = 0; k < 3; ++k) link(part[k], 0, part[following(k)], 1);
}

// Both triangles at a side are cut in two.
void InsertionMesh::insert_on_side(Vertex v, Slot s, int k) {
  const Slot t = across(s, k);
  const int j = side_towards(t, s);
  const Vertex c = corner(s, k), a = corner(s, following(k)), b = corner(s, preceding(k)), d = corner(t, j);
  const std::array<Vertex, 4> around{c, a, d, b};
  const std::array<Slot, 4> outside{across(s, preceding(k)), across(t, following(j)), across(t, preceding(j)),
                                    across(s, following(k))};
  const std::array<Slot, 4> owner{s, t, t, s};
  std::array<int, 4> back{};
  for (std::size_t i = 0; i < 4; ++i) back[i] = side_towards(outside[i], owner[i]);
  const std::array<Slot, 4> part{s, t, new_slot(), new_slot()};
  for (std::size_t i = 0; i < 4; ++i) {
    set(part[i], {around[i], around[(i + 1) % 4], v});
    link(part[i], 2, outside[i], back[i]);
    pending_.push_back(part[i]);
  }
  for (std::size_t i = 0; i < 4; ++i) link(part[i], 0, part[(i + 1) % 4], 1);
}

// Lawson's flips. Each adds an edge at the new vertex, so there are fewer than vertices.
void InsertionMesh::legalize() {
  std::size_t flips = 0;
  while (!pending_.empty()) {
    const Slot s = pending_.back();
    const Slot t = across(s, 2);
    if (!must_flip(s, corner(t, side_towards(t, s)))) {
      pending_.pop_back();
      continue;
    }
    if (++flips > slots()) refuse();
    flip(s);
    pending_.push_back(t);
  }
}

// Whether the side opposite to the new vertex, at corner 2, is none in the new triangulation. A side to
// infinity is none if the hull turned right at its end.
bool InsertionMesh::must_flip(Slot s, Vertex opposite) const {
  const Vertex a = corner(s, 0), b = corner(s, 1), v = corner(s, 2);
  if (b == infinity) return turn(opposite, a, v) < 0;
  if (a == infinity) return turn(v, b, opposite) < 0;
  if (opposite == infinity) return false;
  return kernel::incircle(point(a), point(b), point(v), point(opposite)) > 0;
}

// The triangles a, b, v and b, a, d become a, d, v and d, b, v.
void InsertionMesh::flip(Slot s) {
  const Slot t = across(s, 2);
  const int j = side_towards(t, s);
  const Vertex a = corner(s, 0), b = corner(s, 1), v = corner(s, 2), d = corner(t, j);
  const Slot beside_a = across(t, corner_of(t, b)), beside_b = across(t, corner_of(t, a));
  const Slot along_b = across(s, 0);
  const int at_a = side_towards(beside_a, t), at_b = side_towards(beside_b, t),
            at_v = side_towards(along_b, s);
  set(s, {a, d, v});
  set(t, {d, b, v});
  link(s, 2, beside_a, at_a);
  link(t, 2, beside_b, at_b);
  link(t, 0, along_b, at_v);
  link(s, 0, t, 1);
}

// Cocircular polygons.

void InsertionMesh::make_fans() {
  fanned_.assign(slots(), 0);
  for (std::size_t i = 0; i < changed_slots_.size(); ++i) {  // fans add to them
    const Slot s = changed_slots_[i];
    if (is_ghost(s) || fanned_[static_cast<std::size_t>(s)]) continue;
    for (int k = 0; k < 3; ++k) {
      if (is_diagonal(s, k)) {
        make_fan(s);
        break;
      }
    }
  }
}

bool InsertionMesh::is_diagonal(Slot s, int k) const {
  const Slot t = across(s, k);
  if (is_ghost(t)) return false;
  const Vertex d = corner(t, side_towards(t, s));
  return kernel::incircle(point(corner(s, 0)), point(corner(s, 1)), point(corner(s, 2)), point(d)) == 0;
}

// The polygon's triangles are found and its sides walked along; then the same slots are filled anew.
void InsertionMesh::make_fan(Slot within) {
  std::vector<Slot> members{within};
  std::vector<Side> sides;
  fanned_[static_cast<std::size_t>(within)] = 1;
  // Depth first, each triangle from the side that it was entered by: the sides come counter-clockwise.
  struct Step {
    Slot s;
    int next, left;
  };
  std::vector<Step> path{{within, 0, 3}};
  while (!path.empty()) {
    Step& step = path.back();
    if (step.left == 0) {
      path.pop_back();
      continue;
    }
    const Slot s = step.s;
    const int k = step.next;
    step.next = following(k);
    --step.left;
    const Slot t = across(s, k);
    const int j = side_towards(t, s);
    if (is_diagonal(s, k)) {
      members.push_back(t);
      fanned_[static_cast<std::size_t>(t)] = 1;
      path.push_back({t, following(j), 2});
    } else {
      sides.push_back({corner(s, following(k)), t, j});
    }
  }
  const auto before = [&](const Side& a, const Side& b) {
    return lexicographic_less(point(a.from), point(b.from));
  };
  std::rotate(sides.begin(), std::min_element(sides.begin(), sides.end(), before), sides.end());
  for (std::size_t i = 0; i < members.size(); ++i) {  // between the apex and side i + 1
    set(members[i], {sides[0].from, sides[i + 1].from, sides[i + 2].from});
    link(members[i], 0, sides[i + 1].outside, sides[i + 1].k);
    if (i > 0) link(members[i], 2, members[i - 1], 1);
  }
  link(members.front(), 2, sides.front().outside, sides.front().k);
  link(members.back(), 1, sides.back().outside, sides.back().k);
}

}  // namespace vorotool::core::delaunay
