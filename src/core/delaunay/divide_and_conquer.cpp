#include "core/delaunay/divide_and_conquer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/kernel/predicates.hpp"
#include "core/numbers/dyadic_grid.hpp"
#include "core/numbers/sign.hpp"

namespace vorotool::core::delaunay {

using kernel::lexicographic_less;
using kernel::Point;

namespace {

bool less_by_y(const Point& a, const Point& b) { return (a.y < b.y) | (!(b.y < a.y) & (a.x < b.x)); }

// Extreme vertices of a part, by (x, y) and by (y, x), so they are ends even of a chain.
struct Hull {
  Vertex least_x = 0, most_x = 0, least_y = 0, most_y = 0;
  bool is_chain = true;  // all points are collinear
};

// A node of the recursion that is left for later: its children come first.
struct Part {
  std::int32_t first = 0, last = 0;    // points
  std::int32_t left = -1, right = -1;  // parts; none for a part that one thread does by itself
  bool by_x = false;                   // how the children are cut
  Hull hull;
};

// Up to which permanents the cross products and the determinants of circles cannot have been rounded: if all
// coordinates are multiples of a step s, the products are multiples of s^2 and s^4, and doubles hold all of
// these up to 2^53 times as much.
struct ExactLimits {
  double cross = 0, circle = 0;

  ExactLimits() = default;
  explicit ExactLimits(double step) : cross(0x1p52 * step * step), circle(cross * step * step) {}
};

// Limits for points on a lattice; of one so fine that hardly any determinant would be small enough, none.
ExactLimits exact_limits(std::span<const RingVertex> vertices) {
  constexpr int most_bits = 32;
  constexpr int most_magnitude = 100;  // 2^-400 does not underflow, and 2^452 does not overflow
  int least = 1024, above = -1074;
  for (const RingVertex& vertex : vertices) {
    for (const double value : {vertex.point.x, vertex.point.y}) {
      const numbers::OddMantissa parts(value);
      if (parts.mantissa == 0) continue;
      least = std::min(least, parts.exponent);
      above = std::max(above, parts.exponent + parts.width());
    }
    if (above - least > most_bits) return {};
  }
  return std::abs(least) <= most_magnitude ? ExactLimits(std::ldexp(1.0, least)) : ExactLimits();
}

// Where along a ring the candidates of a base are: from it counter-clockwise at its left end, clockwise at
// its right end.
enum class Turn { counter_clockwise, clockwise };

template <Turn turn>
std::uint32_t turned(const RingVertex& vertex, std::uint32_t place) {
  return turn == Turn::counter_clockwise ? vertex.after(place) : vertex.before(place);
}

class Builder {
 public:
  explicit Builder(const OrderedPoints& ordered)
      : ordered_(ordered), exact_(exact_limits(ordered.vertices)) {}

  // Position of the cut of points first ... last - 1, at least two, and whether it separates by x.
  std::int32_t cut(std::int32_t first, std::int32_t last, bool& by_x) {
    for (const std::span<const std::uint32_t> code : {ordered_.code, ordered_.fine}) {
      if (code.empty()) continue;
      const auto begin = code.begin() + first;
      const auto end = code.begin() + last;
      const std::uint32_t difference = *begin ^ *(end - 1);
      if (difference == 0) continue;
      // The highest bit in which the codes differ separates the points: those with the bit lie beyond the
      // others.
      const int bit = std::bit_width(difference) - 1;
      by_x = bit % 2 == 1;
      const std::uint32_t threshold = (*(end - 1) >> bit) << bit;
      return static_cast<std::int32_t>(std::lower_bound(begin, end, threshold) - code.begin());
    }
    return cut_by_median(first, last, by_x);
  }

  Hull build(std::int32_t first, std::int32_t last, RingStore& store) {
    bool by_x = false;
    if (last - first <= 3) {
      if (last - first == 3 && is_cell(first, last))
        cut_by_median(first, last, by_x);  // for the order it makes
      return build_few(first, last, store);
    }
    const std::int32_t middle = cut(first, last, by_x);
    const Hull left = build(first, middle, store);
    const Hull right = build(middle, last, store);
    return merge(left, right, by_x, store);
  }

  // Joins two triangulations, of which the left one lies before the right one in the direction of the cut.
  Hull merge(const Hull& left, const Hull& right, bool by_x, RingStore& store) {
    Hull hull = join_hulls(left, right, by_x);
    auto [a, b] = lower_tangent(left, right, by_x);
    if (left.is_chain) turn_chain(a, Turn::counter_clockwise);
    if (right.is_chain) turn_chain(b, Turn::clockwise);
    at(a).insert(0, b, store);
    at(b).insert(at(b).degree(), a, store);
    const bool any_triangle = zip({a, b, 0, at(b).degree() - 1}, store);
    hull.is_chain = left.is_chain && right.is_chain && !any_triangle;
    return hull;
  }

 private:
  // An edge from the left part to the right one, and where in the rings of its ends the other one is.
  struct Base {
    Vertex left, right;
    std::uint32_t in_left, in_right;
  };

  // A neighbor of an end of the base that may make a triangle with it.
  struct Candidate {
    Vertex vertex;
    kernel::Apex apex;
    bool is_valid;
  };

  RingVertex& at(Vertex v) { return vertices_[static_cast<std::size_t>(v)]; }
  const RingVertex& at(Vertex v) const { return vertices_[static_cast<std::size_t>(v)]; }
  const Point& point(Vertex v) const { return at(v).point; }

  // One to three points.
  Hull build_few(Vertex first, Vertex last, RingStore& store) {
    Hull hull{first, first, first, first, true};
    for (Vertex v = first + 1; v < last; ++v) {
      hull.least_x = lexicographic_less(point(v), point(hull.least_x)) ? v : hull.least_x;
      hull.most_x = lexicographic_less(point(v), point(hull.most_x)) ? hull.most_x : v;
      hull.least_y = less_by_y(point(v), point(hull.least_y)) ? v : hull.least_y;
      hull.most_y = less_by_y(point(v), point(hull.most_y)) ? hull.most_y : v;
    }
    const auto link = [&](Vertex a, Vertex b) { at(a).insert(at(a).degree(), b, store); };
    const Vertex second = first + 1, third = first + 2;
    if (last == third) {
      link(first, second);
      link(second, first);
    } else if (last > third) {
      const int side = side_of(second, third, first);
      hull.is_chain = side == 0;
      if (side == 0) {
        const Vertex middle = first ^ second ^ third ^ hull.least_x ^ hull.most_x;
        link(hull.least_x, middle);
        link(middle, hull.least_x);
        link(middle, hull.most_x);
        link(hull.most_x, middle);
      } else {
        const Vertex b = side > 0 ? second : third, c = side > 0 ? third : second;
        link(first, b);
        link(first, c);
        link(b, c);
        link(b, first);
        link(c, first);
        link(c, b);
      }
    }
    return hull;
  }

  bool is_cell(std::int32_t first, std::int32_t last) const {
    const auto equal = [&](std::span<const std::uint32_t> code) {
      return code.empty() ||
             code[static_cast<std::size_t>(first)] == code[static_cast<std::size_t>(last - 1)];
    };
    return equal(ordered_.code) && equal(ordered_.fine);
  }

  // Points of equal code: halves by the wider direction, put in place.
  std::int32_t cut_by_median(std::int32_t first, std::int32_t last, bool& by_x) {
    struct Item {
      Point point;
      std::uint32_t index;
    };
    std::vector<Item> items;
    Point least = point(first);
    Point most = least;
    for (std::int32_t i = first; i < last; ++i) {
      const Point& p = point(i);
      items.push_back({p, ordered_.index[static_cast<std::size_t>(i)]});
      least = {std::min(least.x, p.x), std::min(least.y, p.y)};
      most = {std::max(most.x, p.x), std::max(most.y, p.y)};
    }
    by_x = most.x / 2 - least.x / 2 >= most.y / 2 - least.y / 2;
    const auto less = by_x ? lexicographic_less<Point> : less_by_y;
    const std::int32_t half = (last - first) / 2;
    std::sort(items.begin(), items.end(),
              [&](const Item& a, const Item& b) { return less(a.point, b.point); });
    for (std::int32_t i = first; i < last; ++i) {
      at(i).point = items[static_cast<std::size_t>(i - first)].point;
      ordered_.index[static_cast<std::size_t>(i)] = items[static_cast<std::size_t>(i - first)].index;
    }
    return first + half;
  }

  // The signs of orient2d(l, r, v) and incircle(l, r, v, w), v and w being seen from l and r.
  int side_of(Vertex l, Vertex r, Vertex v, const kernel::Apex& apex) const {
    const int sign = kernel::side_filter(apex, exact_.cross);
    return sign != numbers::undecided ? sign : kernel::orient2d(point(l), point(r), point(v));
  }
  int side_of(Vertex l, Vertex r, Vertex v) const {
    return side_of(l, r, v, kernel::seen_from(point(l), point(r), point(v)));
  }

  // Whether w is inside the circle through l, r and v. Cocircular points are told apart as if each were
  // lifted a little towards the inside of circles, the lexicographically smaller the more by far: this makes
  // fans from smallest vertices, whichever way they are come upon. Of four, the lift of the smallest decides:
  // w itself gets inside and v gets w outside; if l or r does, the determinant changes by its cofactor.
  bool is_inside(Vertex l, Vertex r, const Candidate& v, const Candidate& w) const {
    int sign = kernel::incircle_filter(v.apex, w.apex, exact_.circle);
    if (sign == numbers::undecided)
      sign = kernel::incircle_beyond_filter(point(l), point(r), point(v.vertex), point(w.vertex));
    if (sign != 0) return sign > 0;
    const auto earlier = [&](Vertex a, Vertex b) { return lexicographic_less(point(b), point(a)) ? b : a; };
    const Vertex smallest = earlier(earlier(l, r), earlier(v.vertex, w.vertex));
    if (smallest == l) return side_of(r, v.vertex, w.vertex) < 0;
    if (smallest == r) return side_of(v.vertex, l, w.vertex) < 0;
    return smallest == w.vertex;
  }

  // The ends of the edge of the hull below both parts, seen along the cut: in the left one, in the right one.
  std::pair<Vertex, Vertex> lower_tangent(const Hull& left, const Hull& right, bool by_x) const {
    Vertex a = by_x ? left.most_x : left.most_y;
    Vertex b = by_x ? right.least_x : right.least_y;
    Vertex next_a = at(a).degree() == 0 ? a : at(a).back();  // clockwise along the hull
    Vertex next_b = at(b).degree() == 0 ? b : at(b).front();
    // The hull goes on at the other end of the ring, in a chain as well.
    const auto step = [&](Vertex& v, Vertex& next) {
      const Vertex from = std::exchange(v, next);
      next = at(v).front() == from ? at(v).back() : at(v).front();
    };
    for (;;) {
      if (next_a != a && side_of(a, next_a, b) > 0) {
        step(a, next_a);
      } else if (next_b != b && side_of(b, next_b, a) < 0) {
        step(b, next_b);
      } else {
        return {a, b};
      }
    }
  }

  // In a chain the unbounded face is on both sides. This puts it to the end of each ring on the side that
  // stays, when the other one, to which the candidates turn at the end of the base, gets triangles.
  void turn_chain(Vertex end, Turn turn) {
    if (at(end).degree() == 0) return;
    Vertex v = at(end).front();
    while (at(v).degree() == 2) {
      Vertex* ring = at(v).ring();
      const Vertex next = ring[0] == end ? ring[1] : ring[0];
      ring[turn == Turn::counter_clockwise ? 0 : 1] = end;
      ring[turn == Turn::counter_clockwise ? 1 : 0] = next;
      end = std::exchange(v, next);
    }
  }

  // Goes up from the lower tangent, taking out edges of both parts that are not Delaunay and adding those
  // between them. Tells whether it made any triangle.
  bool zip(Base base, RingStore& store) {
    for (bool any = false;; any = true) {
      const auto [left, right, in_left, in_right] = base;
      const Candidate l = candidate<Turn::counter_clockwise>(base, left, right, base.in_left);
      const Candidate r = candidate<Turn::clockwise>(base, right, left, base.in_right);
      if (!l.is_valid && !r.is_valid) return any;
      if (!l.is_valid || (r.is_valid && is_inside(left, right, l, r))) {
        const std::uint32_t place = at(r.vertex).find(right);
        at(r.vertex).insert(place, left, store);
        at(left).insert(++base.in_left, r.vertex, store);
        base.right = r.vertex;
        base.in_right = place;
      } else {
        const std::uint32_t place = at(l.vertex).find(left) + 1;
        at(l.vertex).insert(place, right, store);
        at(right).insert(base.in_right, l.vertex, store);
        base.left = l.vertex;
        base.in_left = place;
      }
    }
  }

  // The neighbor next to the base at one end of it. Neighbors whose circle with the base holds the one
  // after them are taken out.
  template <Turn turn>
  Candidate candidate(const Base& base, Vertex end, Vertex other_end, std::uint32_t& base_place) {
    RingVertex& vertex = at(end);
    std::uint32_t place = turned<turn>(vertex, base_place);
    Candidate chosen = seen(base, vertex.ring()[place]);
    // An end without other neighbors turns back to the base itself.
    chosen.is_valid =
        chosen.vertex != other_end && side_of(base.left, base.right, chosen.vertex, chosen.apex) > 0;
    if (!chosen.is_valid) return chosen;
    for (;;) {
      const Vertex following = vertex.ring()[turned<turn>(vertex, place)];
      if (following == other_end) return chosen;
      Candidate next = seen(base, following);
      if (!is_inside(base.left, base.right, chosen, next)) return chosen;
      vertex.erase(place);
      if (place < base_place) --base_place;
      at(chosen.vertex).erase(at(chosen.vertex).find(end));
      place = turned<turn>(vertex, base_place);
      chosen = next;
    }
  }

  Candidate seen(const Base& base, Vertex v) const {
    return {v, kernel::seen_from(point(base.left), point(base.right), point(v)), true};
  }

  Hull join_hulls(const Hull& left, const Hull& right, bool by_x) const {
    Hull hull{left.least_x, right.most_x, left.least_y, right.most_y, false};
    if (by_x) {
      if (less_by_y(point(right.least_y), point(left.least_y))) hull.least_y = right.least_y;
      if (less_by_y(point(right.most_y), point(left.most_y))) hull.most_y = left.most_y;
    } else {
      if (lexicographic_less(point(right.least_x), point(left.least_x))) hull.least_x = right.least_x;
      if (lexicographic_less(point(right.most_x), point(left.most_x))) hull.most_x = left.most_x;
    }
    return hull;
  }

  const OrderedPoints& ordered_;
  const std::span<RingVertex> vertices_ = ordered_.vertices;
  ExactLimits exact_;
};

// Cuts the points into parts for the threads: small enough to share evenly and to feel an interrupt, large
// enough that what is left to merge at the end costs nothing. Children come after their parent.
std::vector<Part> plan_parts(Builder& builder, std::int32_t count, unsigned threads) {
  constexpr std::int32_t least = 1024;
  constexpr std::int32_t most = 65536;
  const std::int32_t grain = std::clamp(count / static_cast<std::int32_t>(8 * threads), least, most);
  std::vector<Part> parts(1);
  parts[0].last = count;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::int32_t first = parts[i].first;
    const std::int32_t last = parts[i].last;
    if (last - first <= grain) continue;
    const std::int32_t middle = builder.cut(first, last, parts[i].by_x);
    parts[i].left = static_cast<std::int32_t>(parts.size());
    parts[i].right = parts[i].left + 1;
    parts.emplace_back();
    parts.back().first = first;
    parts.back().last = middle;
    parts.emplace_back();
    parts.back().first = middle;
    parts.back().last = last;
  }
  return parts;
}

// The cuts of divide and conquer, and nothing else: of two points none is made.
void cut_all(Builder& builder, std::int32_t first, std::int32_t last) {
  if (last - first <= 2) return;
  bool by_x = false;
  const std::int32_t middle = builder.cut(first, last, by_x);
  cut_all(builder, first, middle);
  cut_all(builder, middle, last);
}

}  // namespace

void permute_equal_codes(const OrderedPoints& ordered) {
  Builder builder(ordered);
  const auto same = [&](std::size_t i, std::size_t j) {
    return ordered.code[i] == ordered.code[j] && (ordered.fine.empty() || ordered.fine[i] == ordered.fine[j]);
  };
  for (std::size_t first = 0, last = 0; first < ordered.vertices.size(); first = last) {
    while (last < ordered.vertices.size() && same(first, last)) ++last;
    cut_all(builder, static_cast<std::int32_t>(first), static_cast<std::int32_t>(last));
  }
}

Subdivision divide_and_conquer(const OrderedPoints& ordered, unsigned threads, const base::Monitor& monitor) {
  const auto count = static_cast<std::int32_t>(ordered.vertices.size());
  Subdivision result;
  if (count == 0) return result;
  Builder builder(ordered);
  std::vector<Part> parts = plan_parts(builder, count, base::resolve_threads(threads));
  result.stores.resize(parts.size());
  std::vector<std::size_t> leaves;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].left < 0) leaves.push_back(i);
  }
  base::parallel_for(
      leaves.size(), threads,
      [&](std::size_t k) {
        Part& part = parts[leaves[k]];
        part.hull = builder.build(part.first, part.last, result.stores[leaves[k]]);
      },
      monitor);
  for (std::size_t i = parts.size(); i-- > 0;) {
    Part& part = parts[i];
    if (part.left < 0) continue;
    const Hull& left = parts[static_cast<std::size_t>(part.left)].hull;
    const Hull& right = parts[static_cast<std::size_t>(part.right)].hull;
    part.hull = builder.merge(left, right, part.by_x, result.stores[i]);
  }
  result.start = parts[0].hull.least_x;
  result.is_chain = parts[0].hull.is_chain;
  return result;
}

}  // namespace vorotool::core::delaunay
