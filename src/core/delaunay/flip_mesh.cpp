#include "core/delaunay/flip_mesh.hpp"

#include <algorithm>

namespace vorotool::core::delaunay {

using kernel::lexicographic_less;

namespace {

constexpr std::size_t steps_between_polls = std::size_t{1} << 14;

}  // namespace

FlipMesh::Side FlipMesh::add_triangle(Vertex a, Vertex b, Vertex c) {
  const Side first = sides();
  origins_.insert(origins_.end(), {a, b, c});
  twins_.insert(twins_.end(), 3, -1);
  return first;
}

void FlipMesh::start(Vertex a, Vertex b, Vertex c) {
  if (kernel::orient2d(at(a), at(b), at(c)) < 0) std::swap(b, c);
  const Side inner = add_triangle(a, b, c);
  const Side ghosts[] = {add_triangle(b, a, infinity), add_triangle(c, b, infinity),
                         add_triangle(a, c, infinity)};
  for (int k = 0; k < 3; ++k) {
    link(inner + k, ghosts[k]);
    link(preceding(ghosts[k]), following(ghosts[(k + 1) % 3]));  // from infinity to the second of a, b, c
  }
}

// Of a triangle with collinear corners.
FlipMesh::Side FlipMesh::opposite_to_middle(Side s) const {
  while (lexicographic_less(at(apex(s)), at(origin(s))) == lexicographic_less(at(apex(s)), at(target(s))))
    s = following(s);
  return s;
}

std::uint64_t FlipMesh::straighten() {
  std::vector<Side> flat;
  for (Side s = 0; s < sides(); s += 3) {
    if (is_flat(s)) flat.push_back(s);
  }
  std::uint64_t flips = 0, before = 0;
  do {
    before = flips;
    std::size_t kept = 0;
    for (const Side t : flat) {
      if (!is_flat(t)) continue;
      const Side s = opposite_to_middle(t);
      if (is_flat(twin(s))) {
        flat[kept++] = t;
        continue;
      }
      flip(s);
      ++flips;
    }
    flat.resize(kept);
  } while (flips > before);
  doubtful_.clear();
  return flips;
}

bool FlipMesh::is_positive() const {
  for (Side s = 0; s < sides(); s += 3) {
    if (!is_ghost(s) && side_of(s, apex(s)) <= 0) return false;
  }
  return true;
}

bool FlipMesh::has_triangle() const {
  for (Side s = 0; s < sides(); s += 3) {
    if (!is_ghost(s)) return true;
  }
  return false;
}

void FlipMesh::poll() {
  if (++steps_ % steps_between_polls == 0) base::report(monitor_, 0.9);
}

// Of a side that ends at infinity: whether its other end is a reflex turn of the hull. Of a side of the hull:
// never. Of any other: whether the circle of one of its triangles holds the apex of the other; if this is on
// the circle, the diagonal belongs to the lexicographically smallest of the four, by the same symbolic lift
// as in divide and conquer.
bool FlipMesh::is_wrong(Side s) const {
  if (origin(s) == infinity) s = twin(s);
  const Vertex a = origin(s), b = target(s), c = apex(s), d = apex(twin(s));
  if (b == infinity) return c != infinity && d != infinity && kernel::orient2d(at(d), at(a), at(c)) < 0;
  if (c == infinity || d == infinity) return false;
  if (const int sign = kernel::incircle(at(a), at(b), at(c), at(d)); sign != 0) return sign > 0;
  const auto earlier = [&](Vertex v, Vertex w) {
    return std::min(at(v), at(w), lexicographic_less<kernel::Point>);
  };
  return lexicographic_less(earlier(c, d), earlier(a, b));
}

// Replaces the side a, b of the triangles a, b, c and b, a, d: they become d, b, c and c, a, d. Sides keep
// their triangle.
void FlipMesh::flip(Side s) {
  const Side t = twin(s);
  const Side before_s = preceding(s), before_t = preceding(t);
  origin(s) = origin(before_t);
  origin(t) = origin(before_s);
  link(s, twin(before_t));
  link(t, twin(before_s));
  link(before_s, before_t);
  doubtful_.insert(doubtful_.end(), {s, following(s), t, following(t)});
}

// Every flip lowers the triangulation lifted to the paraboloid, if only symbolically, or fills a part of the
// hull: it comes to an end.
void FlipMesh::settle() {
  while (!doubtful_.empty()) {
    poll();
    const Side s = doubtful_.back();
    doubtful_.pop_back();
    if (!is_wrong(s)) continue;
    ++(origin(s) == infinity || target(s) == infinity ? fills_ : flips_);
    flip(s);
  }
}

void FlipMesh::make_delaunay() {
  for (const bool at_infinity : {true, false}) {
    for (Side s = 0; s < sides(); ++s) {
      if (s < twin(s) && (origin(s) == infinity || target(s) == infinity) == at_infinity)
        doubtful_.push_back(s);
    }
    settle();
  }
}

// A side of the triangle, or of the ghost, in which a point lies; on the border of a triangle, that side.
FlipMesh::Side FlipMesh::find(Vertex v) const {
  Side s = recent_ - recent_ % 3;
  if (is_ghost(s)) {
    while (apex(s) != infinity) ++s;
    s = twin(s);
  }
  // In a Delaunay triangulation the walk to any triangle that the point can be seen in comes to an end.
  for (int checked = 0; checked < 3;) {
    if (side_of(s, v) < 0) {
      s = twin(s);
      if (is_ghost(s)) return s;
      checked = 0;
    } else {
      ++checked;
    }
    s = following(s);
  }
  for (int k = 0; k < 3 && side_of(s, v) != 0; ++k) s = following(s);
  return s;
}

// Puts v into the triangle of a side: a, b, c becomes a, b, v and b, c, v and c, a, v.
void FlipMesh::split(Side s, Vertex v) {
  const Side second = following(s), third = preceding(s);
  const Vertex a = origin(s), b = origin(second), c = origin(third);
  const Side bc = add_triangle(b, c, v);
  const Side ca = add_triangle(c, a, v);
  link(bc, twin(second));
  link(ca, twin(third));
  origin(third) = v;
  link(second, preceding(bc));
  link(third, following(ca));
  link(following(bc), preceding(ca));
  doubtful_.insert(doubtful_.end(), {s, bc, ca});
}

void FlipMesh::insert(Vertex v) {
  const Side s = find(v);
  const bool on_side = !is_ghost(s) && side_of(s, v) == 0;
  split(s, v);
  if (on_side) {  // the triangle at s is flat: its side is replaced before any other is looked at
    flip(s);
  }
  recent_ = s;
  settle();
}

// Lists the neighbors of the vertex that a side leaves, from that of the side on. Returns how many sides
// leave it, one to infinity among them.
FlipMesh::Side FlipMesh::make_ring(Side start, RingStore& store) {
  RingVertex& vertex = vertices_[static_cast<std::size_t>(origin(start))];
  Side count = 0;
  Side s = start;
  do {
    if (target(s) != infinity) vertex.insert(vertex.degree(), target(s), store);
    s = twin(preceding(s));
    ++count;
  } while (s != start);
  return count;
}

std::optional<Subdivision> FlipMesh::subdivision() {
  // Euler's relation on the sphere, with the vertex at infinity.
  if (static_cast<std::size_t>(sides()) != 6 * vertices_.size() - 6) return {};
  for (RingVertex& vertex : vertices_) vertex.clear(vertex.point);
  Subdivision result;
  result.is_chain = false;
  RingStore& store = result.stores.emplace_back();
  // The sides that leave a vertex must be one ring. That of a vertex of the hull begins after infinity.
  auto ringed = static_cast<Side>(std::count(origins_.begin(), origins_.end(), infinity));
  for (const bool on_hull : {true, false}) {
    for (Side s = 0; s < sides(); ++s) {
      const Vertex v = origin(s);
      if (v == infinity || (on_hull && target(s) != infinity)) continue;
      if (vertices_[static_cast<std::size_t>(v)].degree() > 0) continue;
      ringed += make_ring(on_hull ? twin(preceding(s)) : s, store);
      if (result.start < 0 || lexicographic_less(at(v), at(result.start))) result.start = v;
    }
  }
  const auto has_ring = [](const RingVertex& vertex) { return vertex.degree() > 0; };
  if (ringed != sides() || !std::all_of(vertices_.begin(), vertices_.end(), has_ring)) return {};
  return result;
}

}  // namespace vorotool::core::delaunay
