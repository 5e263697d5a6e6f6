#include "core/divide_and_conquer.hpp"

#include <algorithm>
#include <bit>
#include <vector>

#include "core/parallel.hpp"

namespace vorotool::core {

namespace {

bool less_by_x(const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }
bool less_by_y(const Point& a, const Point& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }

// An extreme vertex of the hull of a part, and the half-edge that leaves it counter-clockwise along the hull;
// a part of one point has no edge.
struct Extreme {
  Vertex vertex = -1;
  HalfEdge edge = no_edge;
};

// Extremes are taken by (x, y) and by (y, x), so they are ends even of a chain.
struct Hull {
  Extreme least_x, most_x, least_y, most_y;
};

// What a thread owns while it works on a part: edges that may be made, and whether any predicate was zero. A
// part of k points has at most 3 k edges, so each part owns the numbers 3 first ... 3 last.
class Workshop {
 public:
  // Notes a sign that is zero.
  int seen(int sign) {
    degenerate_ |= sign == 0;
    return sign;
  }
  bool degenerate() const { return degenerate_; }

  void own(std::int32_t first, std::int32_t last) { ranges_.push_back({first, last}); }

  HalfEdge take() {
    if (!free_.empty()) {
      const HalfEdge e = free_.back();
      free_.pop_back();
      return e;
    }
    while (ranges_.back().first == ranges_.back().last) ranges_.pop_back();
    return 2 * ranges_.back().first++;
  }

  void give_back(HalfEdge e) { free_.push_back(e & ~1); }

  // Calls visit(edge) for the numbers that were never taken.
  template <class Visit>
  void for_untaken(Visit visit) const {
    for (const Range& range : ranges_) {
      for (std::int32_t k = range.first; k < range.last; ++k) visit(2 * k);
    }
  }

  void absorb(Workshop& other) {
    degenerate_ |= other.degenerate_;
    free_.insert(free_.end(), other.free_.begin(), other.free_.end());
    ranges_.insert(ranges_.end(), other.ranges_.begin(), other.ranges_.end());
    other = {};
  }

 private:
  struct Range {
    std::int32_t first, last;
  };
  std::vector<HalfEdge> free_;
  std::vector<Range> ranges_;
  bool degenerate_ = false;
};

// A node of the recursion that is left for later: its children come first.
struct Part {
  std::int32_t first = 0, last = 0;    // points
  std::int32_t left = -1, right = -1;  // parts; none for a part that one thread does by itself
  bool by_x = false;                   // how the children are cut
  Hull hull;
  Workshop shop;
};

class Builder {
 public:
  Builder(const OrderedPoints& ordered, HalfEdges& edges) : ordered_(ordered), edges_(edges) {}

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

  Hull build(std::int32_t first, std::int32_t last, Workshop& shop) {
    if (last - first == 1) return {{first}, {first}, {first}, {first}};
    if (last - first == 2) return build_edge(first, shop);
    bool by_x = false;
    const std::int32_t middle = cut(first, last, by_x);
    const Hull left = build(first, middle, shop);
    const Hull right = build(middle, last, shop);
    return merge(left, right, by_x, shop);
  }

  // Joins two triangulations, of which the left one lies before the right one in the direction of the cut.
  Hull merge(const Hull& left, const Hull& right, bool by_x, Workshop& shop) {
    HalfEdge base = lower_tangent(left, right, by_x, shop);
    const HalfEdge lower = HalfEdges::twin(base);
    base = zip(base, shop);
    return join_hulls(left, right, by_x, lower, base);
  }

 private:
  Hull build_edge(std::int32_t first, Workshop& shop) {
    const HalfEdge e = shop.take();
    edges_.make(e, first, first + 1);
    const Extreme one{first, e};
    const Extreme two{first + 1, HalfEdges::twin(e)};
    const bool x_up = less_by_x(at(first), at(first + 1));
    const bool y_up = less_by_y(at(first), at(first + 1));
    return {x_up ? one : two, x_up ? two : one, y_up ? one : two, y_up ? two : one};
  }

  // Points of equal code: halves by the wider direction, put in place.
  std::int32_t cut_by_median(std::int32_t first, std::int32_t last, bool& by_x) {
    struct Item {
      Point point;
      std::uint32_t index;
    };
    std::vector<Item> items;
    Point least = at(first);
    Point most = least;
    for (std::int32_t i = first; i < last; ++i) {
      const Point& p = at(i);
      items.push_back({p, ordered_.index[static_cast<std::size_t>(i)]});
      least = {std::min(least.x, p.x), std::min(least.y, p.y)};
      most = {std::max(most.x, p.x), std::max(most.y, p.y)};
    }
    by_x = most.x / 2 - least.x / 2 >= most.y / 2 - least.y / 2;
    const auto less = by_x ? less_by_x : less_by_y;
    const std::int32_t half = (last - first) / 2;
    std::sort(items.begin(), items.end(),
              [&](const Item& a, const Item& b) { return less(a.point, b.point); });
    for (std::int32_t i = first; i < last; ++i) {
      points_[static_cast<std::size_t>(i)] = items[static_cast<std::size_t>(i - first)].point;
      ordered_.index[static_cast<std::size_t>(i)] = items[static_cast<std::size_t>(i - first)].index;
    }
    return first + half;
  }

  int side(Vertex a, Vertex b, Vertex v, Workshop& shop) const {
    return shop.seen(orient2d(at(a), at(b), at(v)));
  }
  int in_circle(Vertex a, Vertex b, Vertex c, Vertex v, Workshop& shop) const {
    return shop.seen(incircle(at(a), at(b), at(c), at(v)));
  }
  const Point& at(Vertex v) const { return points_[static_cast<std::size_t>(v)]; }

  // Makes the edge of the hull below both parts, from the right part to the left one, seen along the cut.
  HalfEdge lower_tangent(const Hull& left, const Hull& right, bool by_x, Workshop& shop) {
    Extreme a = by_x ? left.most_x : left.most_y;
    Extreme b = by_x ? right.least_x : right.least_y;
    const bool left_single = a.edge == no_edge;
    const bool right_single = b.edge == no_edge;
    if (!left_single) a.edge = edges_.previous_around(a.edge);  // clockwise along the hull
    for (;;) {
      if (!left_single && side(a.vertex, edges_.target(a.edge), b.vertex, shop) > 0) {
        a.edge = edges_.next_left(a.edge);
        a.vertex = edges_.origin(a.edge);
      } else if (!right_single && side(b.vertex, edges_.target(b.edge), a.vertex, shop) < 0) {
        b.edge = edges_.previous_right(b.edge);
        b.vertex = edges_.origin(b.edge);
      } else {
        break;
      }
    }
    const HalfEdge base = shop.take();
    edges_.make(base, b.vertex, a.vertex);
    if (!right_single) edges_.splice(base, edges_.previous_around(b.edge));
    if (!left_single) edges_.splice(HalfEdges::twin(base), a.edge);
    return base;
  }

  // Goes up from the lower tangent, taking out edges of both parts that are not Delaunay and adding those
  // between them. Returns the upper tangent, from the right part to the left one.
  HalfEdge zip(HalfEdge base, Workshop& shop) {
    for (;;) {
      const Vertex left = edges_.target(base);
      const Vertex right = edges_.origin(base);
      HalfEdge l = edges_.next_around(HalfEdges::twin(base));
      HalfEdge r = edges_.previous_around(base);
      // A vertex without other edges turns back to the base itself.
      const bool l_valid = l != HalfEdges::twin(base) && side(right, left, edges_.target(l), shop) < 0;
      const bool r_valid = r != base && side(right, left, edges_.target(r), shop) < 0;
      if (!l_valid && !r_valid) return base;
      if (l_valid) l = clear_candidates<&HalfEdges::next_around>(l, left, right, right, shop);
      if (r_valid) r = clear_candidates<&HalfEdges::previous_around>(r, left, right, left, shop);
      const bool from_right =
          !l_valid || (r_valid && in_circle(edges_.target(l), left, right, edges_.target(r), shop) > 0);
      const HalfEdge cross = shop.take();
      if (from_right) {
        edges_.connect(cross, r, HalfEdges::twin(base));
      } else {
        edges_.connect(cross, HalfEdges::twin(base), HalfEdges::twin(l));
      }
      base = cross;
    }
  }

  // Takes out the candidates whose circle with the base holds the candidate after them, turning away from the
  // base; returns the one that stays. `end` is the far end of the base.
  template <HalfEdge (HalfEdges::*turned)(HalfEdge) const>
  HalfEdge clear_candidates(HalfEdge candidate, Vertex left, Vertex right, Vertex end, Workshop& shop) {
    for (;;) {
      const HalfEdge following = (edges_.*turned)(candidate);
      const Vertex v = edges_.target(following);
      if (v == end || in_circle(left, right, edges_.target(candidate), v, shop) <= 0) return candidate;
      edges_.remove(candidate);
      shop.give_back(candidate);
      candidate = following;
    }
  }

  // An extreme vertex keeps its half-edge along the hull unless a tangent leaves it.
  Hull join_hulls(const Hull& left, const Hull& right, bool by_x, HalfEdge lower, HalfEdge upper) const {
    const auto mended = [&](Extreme extreme) {
      if (extreme.vertex == edges_.origin(lower)) extreme.edge = lower;
      if (extreme.vertex == edges_.origin(upper)) extreme.edge = upper;
      return extreme;
    };
    if (by_x) {
      const bool least = less_by_y(at(right.least_y.vertex), at(left.least_y.vertex));
      const bool most = less_by_y(at(left.most_y.vertex), at(right.most_y.vertex));
      return {mended(left.least_x), mended(right.most_x), mended(least ? right.least_y : left.least_y),
              mended(most ? right.most_y : left.most_y)};
    }
    const bool least = less_by_x(at(right.least_x.vertex), at(left.least_x.vertex));
    const bool most = less_by_x(at(left.most_x.vertex), at(right.most_x.vertex));
    return {mended(least ? right.least_x : left.least_x), mended(most ? right.most_x : left.most_x),
            mended(left.least_y), mended(right.most_y)};
  }

  const OrderedPoints& ordered_;
  const std::span<Point> points_ = ordered_.points;
  HalfEdges& edges_;
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

// The cuts of divide and conquer, and nothing else: below two points none is made.
void cut_all(Builder& builder, std::int32_t first, std::int32_t last) {
  if (last - first <= 2) return;
  bool by_x = false;
  const std::int32_t middle = builder.cut(first, last, by_x);
  cut_all(builder, first, middle);
  cut_all(builder, middle, last);
}

}  // namespace

void permute_equal_codes(const OrderedPoints& ordered) {
  HalfEdges none(0);
  Builder builder(ordered, none);
  const auto same = [&](std::size_t i, std::size_t j) {
    return ordered.code[i] == ordered.code[j] && (ordered.fine.empty() || ordered.fine[i] == ordered.fine[j]);
  };
  for (std::size_t first = 0, last = 0; first < ordered.points.size(); first = last) {
    while (last < ordered.points.size() && same(first, last)) ++last;
    cut_all(builder, static_cast<std::int32_t>(first), static_cast<std::int32_t>(last));
  }
}

Subdivision divide_and_conquer(const OrderedPoints& ordered, unsigned threads, const Monitor& monitor) {
  const auto count = static_cast<std::int32_t>(ordered.points.size());
  Subdivision result{HalfEdges(3 * ordered.points.size())};
  if (count == 0) return result;
  Builder builder(ordered, result.edges);
  std::vector<Part> parts = plan_parts(builder, count, resolve_threads(threads));
  std::vector<std::size_t> leaves;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].left < 0) leaves.push_back(i);
  }
  parallel_for(
      leaves.size(), threads,
      [&](std::size_t k) {
        Part& part = parts[leaves[k]];
        part.shop.own(3 * part.first, 3 * part.last);
        part.hull = builder.build(part.first, part.last, part.shop);
      },
      monitor);
  for (std::size_t i = parts.size(); i-- > 0;) {
    Part& part = parts[i];
    if (part.left < 0) continue;
    Part& left = parts[static_cast<std::size_t>(part.left)];
    Part& right = parts[static_cast<std::size_t>(part.right)];
    part.shop.absorb(left.shop);
    part.shop.absorb(right.shop);
    part.hull = builder.merge(left.hull, right.hull, part.by_x, part.shop);
  }
  parts[0].shop.for_untaken([&](HalfEdge e) { result.edges.clear(e); });
  result.hull = parts[0].hull.least_x.edge;
  result.degenerate = parts[0].shop.degenerate();
  return result;
}

}  // namespace vorotool::core
