#include "core/delaunay/verify_triangulation.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <vector>

#include "core/base/radix_sort.hpp"
#include "core/kernel/predicates.hpp"

namespace vorotool::core::delaunay {

using base::Fault;
using base::Monitor;
using base::none;
using kernel::orient2d;
using kernel::Point;

namespace {

using Index = std::int32_t;

// As kernel::lexicographic_less, written again: a checker shares no order with what it checks.
bool comes_before(const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

std::string text(const char* what, std::size_t number) { return what + std::to_string(number); }

std::string edge_text(Index a, Index b) { return "edge " + std::to_string(a) + "-" + std::to_string(b); }

// A set of directed edges.
class EdgeSet {
 public:
  explicit EdgeSet(std::size_t vertices) : vertices_(vertices) {}

  void add(Index a, Index b) { keys_.push_back({key(a, b), static_cast<std::uint32_t>(keys_.size())}); }
  void sort() { base::radix_sort(keys_, std::bit_width(vertices_ * vertices_)); }

  // Once sorted: the number, in the order in which they were added, of an edge that was added before; or
  // none.
  std::size_t first_repeated() const {
    std::size_t found = none;
    for (std::size_t i = 1; i < keys_.size(); ++i) {
      if (keys_[i].key == keys_[i - 1].key) found = std::min<std::size_t>(found, keys_[i].value);
    }
    return found;
  }

  bool holds(Index a, Index b) const {
    const std::uint64_t wanted = key(a, b);
    const auto less = [](const base::Keyed& item, std::uint64_t value) { return item.key < value; };
    const auto place = std::lower_bound(keys_.begin(), keys_.end(), wanted, less);
    return place != keys_.end() && place->key == wanted;
  }

 private:
  std::uint64_t key(Index a, Index b) const {
    return static_cast<std::uint64_t>(a) * vertices_ + static_cast<std::uint64_t>(b);
  }

  std::size_t vertices_;
  std::vector<base::Keyed> keys_;
};

// Why the checks suffice: positive triangles whose sides cancel in pairs, but for one convex cycle gone round
// once, cover each point inside it as often as the cycle winds around it: once. So they tile the hull; then
// no vertex lies inside a triangle or a side, and if every side is locally Delaunay, all circles are empty
// (Delaunay's lemma).
class Checker {
 public:
  Checker(const TriangulationArrays& arrays, unsigned threads, const Monitor& monitor)
      : in_(arrays),
        threads_(threads),
        monitor_(monitor),
        triangles_(arrays.triangles.size() / 3),
        sides_(arrays.points.size()) {}

  Fault run() {
    if (Fault fault = check_first()) return fault;
    if (Fault fault = check_indices()) return fault;
    if (triangles_ == 0) return check_chain();
    for (const auto check :
         {&Checker::check_orientation, &Checker::check_sides, &Checker::check_neighbors, &Checker::check_hull,
          &Checker::check_vertices, &Checker::check_edges, &Checker::check_circles, &Checker::check_fans}) {
      if (Fault fault = (this->*check)()) return fault;
    }
    return {};
  }

 private:
  const Point& at(Index v) const { return in_.points[static_cast<std::size_t>(v)]; }
  Index corner(std::size_t t, int k) const { return in_.triangles[3 * t + static_cast<std::size_t>(k % 3)]; }
  Index across(std::size_t t, int k) const { return in_.neighbors[3 * t + static_cast<std::size_t>(k % 3)]; }
  bool is_point(Index v) const { return v >= 0 && static_cast<std::size_t>(v) < in_.points.size(); }
  // Whether v may be a vertex: of points at one place only the first is.
  bool is_vertex(Index v) const { return is_point(v) && in_.first[static_cast<std::size_t>(v)] == v; }

  // The smallest number below `count` that is bad, or none.
  template <class Bad>
  std::size_t find(std::size_t count, const Bad& bad) const {
    return base::first_bad(count, std::size_t{1} << 14, bad, threads_, monitor_);
  }

  Fault check_first() {
    const auto wrong = [&](std::size_t i) {
      const Index f = in_.first[i];
      if (f < 0 || static_cast<std::size_t>(f) > i || in_.first[static_cast<std::size_t>(f)] != f)
        return true;
      return at(f).x != in_.points[i].x || at(f).y != in_.points[i].y;
    };
    const std::size_t bad = find(in_.points.size(), wrong);
    if (bad != none) return text("first is not the first point at the same place for point ", bad);
    for (Index i = 0; is_point(i); ++i) {
      if (is_vertex(i)) vertices_.push_back(i);
    }
    std::sort(vertices_.begin(), vertices_.end(),
              [&](Index a, Index b) { return comes_before(at(a), at(b)); });
    for (std::size_t i = 1; i < vertices_.size(); ++i) {
      const auto [a, b] = std::minmax(vertices_[i - 1], vertices_[i]);
      if (!comes_before(at(vertices_[i - 1]), at(vertices_[i]))) {
        return text("first does not tell that point ", static_cast<std::size_t>(b)) +
               text(" lies on point ", static_cast<std::size_t>(a));
      }
    }
    return {};
  }

  Fault check_indices() {
    const auto no_vertex = [&](std::span<const Index> given) {
      return find(given.size(), [=, this](std::size_t i) { return !is_vertex(given[i]); });
    };
    if (const std::size_t bad = no_vertex(in_.triangles); bad != none) {
      return named("triangle ", bad / 3, in_.triangles[bad]);
    }
    if (const std::size_t bad = no_vertex(in_.edges); bad != none)
      return named("edge ", bad / 2, in_.edges[bad]);
    if (const std::size_t bad = no_vertex(in_.hull); bad != none)
      return named("hull vertex ", bad, in_.hull[bad]);
    const auto no_triangle = [&](std::size_t i) {
      const Index u = in_.neighbors[i];
      return u < -1 || (u >= 0 && static_cast<std::size_t>(u) >= triangles_);
    };
    const std::size_t bad = find(in_.neighbors.size(), no_triangle);
    if (bad == none) return {};
    return text("a neighbor of triangle ", bad / 3) + " is " + std::to_string(in_.neighbors[bad]) +
           ", which is no triangle";
  }

  Fault named(const char* what, std::size_t row, Index v) const {
    return text(what, row) + " names point " + std::to_string(v) +
           (is_point(v) ? ", which lies on an earlier point" : ", which does not exist");
  }

  // Fewer than three or collinear points: edges link them in order, and the hull goes from end to end.
  Fault check_chain() const {
    const std::size_t count = vertices_.size();
    const auto beside = [&](std::size_t i) {
      return orient2d(at(vertices_.front()), at(vertices_.back()), at(vertices_[i])) != 0;
    };
    if (find(count, beside) != none) return "there is no triangle, but the points are not collinear";
    if (!std::equal(vertices_.begin(), vertices_.end(), in_.hull.begin(), in_.hull.end())) {
      return "the hull is not the chain of the collinear points";
    }
    EdgeSet given(in_.points.size());
    for (std::size_t i = 0; i < in_.edges.size(); i += 2) given.add(in_.edges[i], in_.edges[i + 1]);
    given.sort();
    for (std::size_t i = 1; i < count; ++i) {
      const auto [a, b] = std::minmax(vertices_[i - 1], vertices_[i]);
      if (!given.holds(a, b)) return edge_text(a, b) + " of the chain is missing";
    }
    if (in_.edges.size() / 2 != count - std::min<std::size_t>(count, 1))
      return "there are edges beside the chain";
    return {};
  }

  Fault check_orientation() {
    const auto wrong = [&](std::size_t t) {
      return orient2d(at(corner(t, 0)), at(corner(t, 1)), at(corner(t, 2))) <= 0;
    };
    const std::size_t bad = find(triangles_, wrong);
    if (bad == none) return {};
    return text("triangle ", bad) + " is not counter-clockwise";
  }

  Fault check_sides() {
    for (std::size_t t = 0; t < triangles_; ++t) {
      for (int k = 0; k < 3; ++k) sides_.add(corner(t, k + 1), corner(t, k + 2));
    }
    sides_.sort();
    const std::size_t bad = sides_.first_repeated();
    if (bad == none) return {};
    const int k = static_cast<int>(bad % 3);
    return text("triangle ", bad / 3) + " has " + edge_text(corner(bad / 3, k + 1), corner(bad / 3, k + 2)) +
           " in the same direction as an earlier one";
  }

  // The corner of u opposite to the side that it shares with corner k of t, or -1.
  int opposite(std::size_t t, int k, std::size_t u) const {
    for (int j = 0; j < 3; ++j) {
      if (corner(u, j + 1) == corner(t, k + 2) && corner(u, j + 2) == corner(t, k + 1)) return j;
    }
    return -1;
  }

  Fault check_neighbors() {
    const auto wrong = [&](std::size_t i) {
      const std::size_t t = i / 3;
      const int k = static_cast<int>(i % 3);
      if (in_.neighbors[i] < 0) return sides_.holds(corner(t, k + 2), corner(t, k + 1));
      return opposite(t, k, static_cast<std::size_t>(in_.neighbors[i])) < 0;
    };
    const std::size_t bad = find(3 * triangles_, wrong);
    if (bad == none) return {};
    return text("triangle ", bad / 3) + text(" has a wrong neighbor opposite to its corner ", bad % 3);
  }

  // The sides without a neighbor are the hull, gone round once. A closed walk that never turns right winds
  // around as often as it turns from falling to rising in lexicographic order.
  Fault check_hull() {
    const std::size_t count = in_.hull.size();
    const auto open = std::count(in_.neighbors.begin(), in_.neighbors.end(), -1);
    if (static_cast<std::size_t>(open) != count) {
      return text("the hull has ", count) +
             text(" vertices, but the triangles have ", static_cast<std::size_t>(open)) +
             " sides without a neighbor";
    }
    const auto vertex = [&](std::size_t i) { return in_.hull[i % count]; };
    std::size_t lows = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Index a = vertex(i), b = vertex(i + 1), c = vertex(i + 2);
      if (!sides_.holds(a, b) || sides_.holds(b, a))
        return "hull " + edge_text(a, b) + " is not on the boundary";
      if (orient2d(at(a), at(b), at(c)) < 0) return "the hull is not convex at point " + std::to_string(b);
      lows += comes_before(at(b), at(a)) && comes_before(at(b), at(c));
    }
    if (lows != 1) return "the hull goes round more than once";
    if (vertex(0) != vertices_.front())
      return "the hull does not begin at its lexicographically smallest vertex";
    return {};
  }

  Fault check_vertices() {
    std::vector<bool> used(in_.points.size(), false);
    for (const Index v : in_.triangles) used[static_cast<std::size_t>(v)] = true;
    const auto unused = [&](Index v) { return !used[static_cast<std::size_t>(v)]; };
    const auto bad = std::find_if(vertices_.begin(), vertices_.end(), unused);
    if (bad == vertices_.end()) return {};
    return text("no triangle has point ", static_cast<std::size_t>(*bad));
  }

  Fault check_edges() {
    const std::size_t count = in_.edges.size() / 2;
    const auto wrong = [&](std::size_t i) {
      const Index a = in_.edges[2 * i], b = in_.edges[2 * i + 1];
      return a >= b || !(sides_.holds(a, b) || sides_.holds(b, a));
    };
    if (const std::size_t bad = find(count, wrong); bad != none) {
      return text("row ", bad) + " of edges is " + edge_text(in_.edges[2 * bad], in_.edges[2 * bad + 1]) +
             ": no side of a triangle, or not its smaller index first";
    }
    EdgeSet given(in_.points.size());
    for (std::size_t i = 0; i < count; ++i) given.add(in_.edges[2 * i], in_.edges[2 * i + 1]);
    given.sort();
    if (const std::size_t bad = given.first_repeated(); bad != none)
      return text("edges repeats itself in row ", bad);
    if (2 * count != 3 * triangles_ + in_.hull.size())
      return text("edges leaves some out: it has only ", count);
    if (vertices_.size() + triangles_ + 1 != count + 2) return "vertices - edges + faces is not 2";
    return {};
  }

  // Sign for the corner across side k of t: 1 inside the circle of t, 0 on it; -1 also if there is none.
  int circle_sign(std::size_t t, int k) const {
    if (across(t, k) < 0) return -1;
    const auto u = static_cast<std::size_t>(across(t, k));
    return kernel::incircle(at(corner(t, 0)), at(corner(t, 1)), at(corner(t, 2)),
                            at(corner(u, opposite(t, k, u))));
  }

  Fault check_circles() {
    cocircular_.assign(3 * triangles_, 0);
    const auto wrong = [&](std::size_t i) {
      const int sign = circle_sign(i / 3, static_cast<int>(i % 3));
      cocircular_[i] = sign == 0;
      return sign > 0;
    };
    const std::size_t bad = find(3 * triangles_, wrong);
    if (bad == none) return {};
    const auto u = static_cast<std::size_t>(in_.neighbors[bad]);
    const int k = opposite(bad / 3, static_cast<int>(bad % 3), u);
    return text("the circle of triangle ", bad / 3) + " holds point " + std::to_string(corner(u, k));
  }

  // Triangles across cocircular sides are one polygon; all these sides must end at its smallest vertex.
  Fault check_fans() {
    std::vector<std::size_t> parent(triangles_);
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t t) {
      while (parent[t] != t) t = parent[t] = parent[parent[t]];
      return t;
    };
    for (std::size_t i = 0; i < cocircular_.size(); ++i) {
      if (cocircular_[i]) parent[root(i / 3)] = root(static_cast<std::size_t>(in_.neighbors[i]));
    }
    std::vector<Index> smallest(triangles_, -1);
    for (std::size_t i = 0; i < in_.triangles.size(); ++i) {
      Index& best = smallest[root(i / 3)];
      if (best < 0 || comes_before(at(in_.triangles[i]), at(best))) best = in_.triangles[i];
    }
    for (std::size_t i = 0; i < cocircular_.size(); ++i) {
      if (!cocircular_[i]) continue;
      const Index a = corner(i / 3, static_cast<int>(i % 3) + 1),
                  b = corner(i / 3, static_cast<int>(i % 3) + 2);
      const Index apex = smallest[root(i / 3)];
      if (a != apex && b != apex) {
        return edge_text(a, b) + " divides a cocircular polygon, but not from its smallest vertex " +
               std::to_string(apex);
      }
    }
    return {};
  }

  const TriangulationArrays& in_;
  const unsigned threads_;
  const Monitor& monitor_;
  const std::size_t triangles_;
  std::vector<Index> vertices_;           // in lexicographic order
  EdgeSet sides_;                         // of the triangles, as they go round
  std::vector<std::uint8_t> cocircular_;  // [3 t] whether the corner across each side lies on the circle
};

}  // namespace

Fault find_fault(const TriangulationArrays& arrays, unsigned threads, const Monitor& monitor) {
  return Checker(arrays, threads, monitor).run();
}

}  // namespace vorotool::core::delaunay
