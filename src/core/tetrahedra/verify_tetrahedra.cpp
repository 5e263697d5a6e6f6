#include "core/tetrahedra/verify_tetrahedra.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/kernel/predicates.hpp"
#include "core/tetrahedra/predicates.hpp"

namespace vorotool::core::tetrahedra {

using base::Fault;
using base::Monitor;
using base::none;

namespace {

using Index = std::int32_t;
using Triangle = std::array<Index, 3>;
using Edge = std::array<Index, 2>;

std::string text(const char* what, std::size_t number) { return what + std::to_string(number); }

// The order of ties, written again: a checker shares no order with what it checks.
std::array<double, 3> place_of(const Point3& p) { return {p.x + 0.0, p.y + 0.0, p.z + 0.0}; }

// Why the checks suffice. The sides without a neighbor are one surface, convex along all edges, all of whose triangles
// have a point within (near the first vertex of the first tetrahedron) on their inner side, and of which a ray from
// there meets one triangle only: it is the boundary of a convex polytope (K. Mehlhorn and others, "Checking geometric
// programs or verification of geometric structures", 1999). Positive tetrahedra that meet in mutual facets cover each
// point inside as often as their boundary winds around it: once. So they tile the polytope, and its vertices are
// vertices of theirs; all points are. A subdivision of the lifted points that is convex across all facets is the lower
// hull of them (Delaunay's lemma), here with heights lowered infinitesimally; that has no other subdivision.
class Checker {
 public:
  Checker(const TetrahedraView& arrays, unsigned threads, const Monitor& monitor)
      : in_(arrays), threads_(threads), monitor_(monitor), count_(arrays.vertices.size()) {}

  Fault run() {
    if (in_.neighbors.size() != count_ || in_.first.size() != in_.points.size())
      return "the arrays do not have the lengths of each other";
    if (Fault fault = check_first()) return fault;
    if (count_ == 0) return check_flat();
    for (const auto check : {&Checker::check_indices, &Checker::check_orientation, &Checker::check_neighbors,
                             &Checker::check_vertices, &Checker::check_surface, &Checker::check_winding,
                             &Checker::check_spheres}) {
      if (Fault fault = (this->*check)()) return fault;
    }
    return {};
  }

 private:
  const Point3& at(Index v) const { return in_.points[static_cast<std::size_t>(v)]; }
  bool is_vertex(Index v) const {
    return v >= 0 && static_cast<std::size_t>(v) < in_.points.size() &&
           in_.first[static_cast<std::size_t>(v)] == v;
  }
  int side(const Triangle& t, Index v) const { return orient3d(at(t[0]), at(t[1]), at(t[2]), at(v)); }

  // The smallest number below `count` that is bad, or none.
  template <class Bad>
  std::size_t find(std::size_t count, const Bad& bad) const {
    return base::first_bad(count, std::size_t{1} << 12, bad, threads_, monitor_);
  }

  // Facet k of a tetrahedron, its vertices such that the tetrahedron is behind it: counter-clockwise from outside.
  Triangle facet(std::size_t t, std::size_t k) const {
    const auto& v = in_.vertices[t];
    switch (k) {
      case 0:
        return {v[1], v[2], v[3]};
      case 1:
        return {v[0], v[3], v[2]};
      case 2:
        return {v[0], v[1], v[3]};
      default:
        return {v[0], v[2], v[1]};
    }
  }

  Fault check_first() {
    std::vector<Index> order(in_.points.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
      return std::pair(place_of(at(a)), a) < std::pair(place_of(at(b)), b);
    });
    Index least = -1;
    for (const Index v : order) {
      if (least < 0 || place_of(at(least)) != place_of(at(v))) least = v;
      if (in_.first[static_cast<std::size_t>(v)] != least)
        return text("first is not the first point at the same place for point ", static_cast<std::size_t>(v));
    }
    return {};
  }

  Fault check_flat() const {
    std::vector<Index> span;
    for (std::size_t i = 0; i < in_.points.size(); ++i) {
      const auto v = static_cast<Index>(i);
      if (!is_vertex(v) || (span.size() == 2 && is_collinear(span[0], span[1], v))) continue;
      if (span.size() == 3 && side({span[0], span[1], span[2]}, v) == 0) continue;
      span.push_back(v);
      if (span.size() == 4) return "there is no tetrahedron, but the points are not coplanar";
    }
    return {};
  }

  bool is_collinear(Index i, Index j, Index k) const {
    const Point3 &a = at(i), &b = at(j), &c = at(k);
    return kernel::orient2d({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 &&
           kernel::orient2d({a.x, a.z}, {b.x, b.z}, {c.x, c.z}) == 0 &&
           kernel::orient2d({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0;
  }

  Fault check_indices() {
    const auto wrong = [&](std::size_t t) {
      return !std::all_of(in_.vertices[t].begin(), in_.vertices[t].end(),
                          [&](Index v) { return is_vertex(v); });
    };
    if (const std::size_t bad = find(count_, wrong); bad != none)
      return text("tetrahedron ", bad) + " names a point that does not exist or lies on an earlier one";
    const auto no_neighbor = [&](std::size_t t) {
      return !std::all_of(in_.neighbors[t].begin(), in_.neighbors[t].end(), [&](Index u) {
        return u == -1 || (u >= 0 && static_cast<std::size_t>(u) < count_);
      });
    };
    if (const std::size_t bad = find(count_, no_neighbor); bad != none)
      return text("tetrahedron ", bad) + " names a neighbor that does not exist";
    return {};
  }

  Fault check_orientation() {
    const auto wrong = [&](std::size_t t) { return side(facet(t, 3), in_.vertices[t][3]) >= 0; };
    const std::size_t bad = find(count_, wrong);
    return bad == none ? Fault() : text("tetrahedron ", bad) + " is not positive";
  }

  // The vertex of u opposite to the facet that it shares with t, or -1: facets must have the same vertices, and each
  // tetrahedron must be the neighbor of the other across that facet.
  Index opposite(std::size_t t, std::size_t k, std::size_t u) const {
    Triangle shared = facet(t, k);
    std::sort(shared.begin(), shared.end());
    for (std::size_t j = 0; j < 4; ++j) {
      Triangle other = facet(u, j);
      std::sort(other.begin(), other.end());
      if (other == shared && in_.neighbors[u][j] == static_cast<Index>(t)) return in_.vertices[u][j];
    }
    return -1;
  }

  Fault check_neighbors() {
    const auto wrong = [&](std::size_t i) {
      const Index u = in_.neighbors[i / 4][i % 4];
      if (u < 0) return false;
      const Index apex = opposite(i / 4, i % 4, static_cast<std::size_t>(u));
      return apex < 0 || side(facet(i / 4, i % 4), apex) <= 0;
    };
    const std::size_t bad = find(4 * count_, wrong);
    if (bad == none) return {};
    return text("tetrahedron ", bad / 4) + text(" has a wrong neighbor opposite to its vertex ", bad % 4);
  }

  Fault check_vertices() {
    std::vector<bool> used(in_.points.size(), false);
    for (const auto& tetrahedron : in_.vertices) {
      for (const Index v : tetrahedron) used[static_cast<std::size_t>(v)] = true;
    }
    for (std::size_t v = 0; v < used.size(); ++v) {
      if (!used[v] && is_vertex(static_cast<Index>(v))) return text("no tetrahedron has point ", v);
    }
    return {};
  }

  // Facets without a neighbor: connected, each edge in two of them, convex there; vertices - edges + faces is 2.
  Fault check_surface() {
    for (std::size_t i = 0; i < 4 * count_; ++i) {
      if (in_.neighbors[i / 4][i % 4] < 0) hull_.push_back(facet(i / 4, i % 4));
    }
    std::vector<std::pair<Edge, std::size_t>> edges;  // with the number of the facet and its corner opposite
    for (std::size_t i = 0; i < 3 * hull_.size(); ++i) {
      const Triangle& t = hull_[i / 3];
      edges.push_back({{t[(i + 1) % 3], t[(i + 2) % 3]}, i});
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 1; i < edges.size(); ++i) {
      if (edges[i].first == edges[i - 1].first)
        return "the hull meets itself along " + edge_text(edges[i].first);
    }
    std::vector<std::size_t> across(edges.size());
    for (const auto& [edge, corner] : edges) {
      const Edge turned{edge[1], edge[0]};
      const auto other = std::lower_bound(edges.begin(), edges.end(), std::pair(turned, std::size_t{0}));
      if (other == edges.end() || other->first != turned) return "the hull is open along " + edge_text(edge);
      across[corner] = other->second;
      if (side(hull_[corner / 3], hull_[other->second / 3][other->second % 3]) > 0)
        return "the hull is not convex along " + edge_text(edge);
    }
    if (!is_connected(across)) return "the hull is not connected";
    std::vector<Index> vertices;
    for (const Triangle& t : hull_) vertices.insert(vertices.end(), t.begin(), t.end());
    std::sort(vertices.begin(), vertices.end());
    const auto distinct =
        static_cast<std::size_t>(std::unique(vertices.begin(), vertices.end()) - vertices.begin());
    if (distinct + hull_.size() != hull_.size() / 2 * 3 + 2)
      return "of the hull, vertices - edges + faces is not 2";
    return {};
  }

  bool is_connected(const std::vector<std::size_t>& across) const {
    std::vector<bool> seen(hull_.size(), false);
    std::vector<std::size_t> found;
    const auto meet = [&](std::size_t t) {
      if (!seen[t]) found.push_back(t);
      seen[t] = true;
    };
    if (!hull_.empty()) meet(0);
    for (std::size_t k = 0; k < found.size(); ++k) {
      for (std::size_t corner = 3 * found[k]; corner < 3 * found[k] + 3; ++corner) meet(across[corner] / 3);
    }
    return found.size() == hull_.size();
  }

  std::string edge_text(const Edge& edge) const {
    return "edge " + std::to_string(edge[0]) + "-" + std::to_string(edge[1]);
  }

  // The side of a plane on which the point within is: near the first vertex of the first tetrahedron, towards its
  // second, infinitely less towards its third and again its fourth.
  int side_of_inner(const Triangle& t) const {
    for (const Index v : in_.vertices[0]) {
      if (const int sign = side(t, v); sign != 0) return sign;
    }
    return 0;
  }

  // All of the hull is seen from within, and once: a ray to the middle of the first facet, near its first vertex and so
  // on, meets no other.
  Fault check_winding() {
    const auto hidden = [&](std::size_t t) { return side_of_inner(hull_[t]) >= 0; };
    if (const std::size_t bad = find(hull_.size(), hidden); bad != none)
      return "the hull is not convex beside " + edge_text({hull_[bad][0], hull_[bad][1]});
    const auto is_left = [&](Index a, Index b) {
      for (const Index v : hull_[0]) {
        if (const int sign = side_of_inner({b, a, v}); sign != 0) return sign > 0;
      }
      return false;
    };
    const auto is_met = [&](std::size_t i) {
      const Triangle& t = hull_[i + 1];
      return is_left(t[0], t[1]) && is_left(t[1], t[2]) && is_left(t[2], t[0]);
    };
    if (const std::size_t bad = find(hull_.size() - 1, is_met); bad != none)
      return "the hull goes round more than once at " + edge_text({hull_[bad + 1][0], hull_[bad + 1][1]});
    return {};
  }

  // Whether the sphere of t, ties broken, holds point v.
  bool holds(std::size_t t, Index v) const {
    const auto& c = in_.vertices[t];
    const int sign = in_sphere(at(c[0]), at(c[1]), at(c[2]), at(c[3]), at(v));
    return sign != 0 ? sign > 0 : holds_tied(t, v);
  }

  // Of five cospherical points the first, in the order of places, is lowered most that changes anything: v, if it is
  // that, comes inside; a vertex takes the sphere with it, away from v if both are on the same side of the facet
  // opposite to the vertex.
  bool holds_tied(std::size_t t, Index v) const {
    std::array<std::pair<std::array<double, 3>, std::size_t>, 5> order;
    for (std::size_t k = 0; k < 4; ++k) order[k] = {place_of(at(in_.vertices[t][k])), k};
    order[4] = {place_of(at(v)), 4};
    std::sort(order.begin(), order.end());
    for (const auto& [place, k] : order) {
      if (k == 4) return true;
      const int sign = side(facet(t, k), v);
      if (sign != 0) return sign > 0;
    }
    return true;
  }

  Fault check_spheres() {
    const auto wrong = [&](std::size_t i) {
      const Index u = in_.neighbors[i / 4][i % 4];
      return u >= 0 && holds(i / 4, opposite(i / 4, i % 4, static_cast<std::size_t>(u)));
    };
    const std::size_t bad = find(4 * count_, wrong);
    if (bad == none) return {};
    const auto u = static_cast<std::size_t>(in_.neighbors[bad / 4][bad % 4]);
    return text("the sphere of tetrahedron ", bad / 4) + " holds point " +
           std::to_string(opposite(bad / 4, bad % 4, u)) + ", or ties are broken in another way";
  }

  const TetrahedraView& in_;
  const unsigned threads_;
  const Monitor& monitor_;
  const std::size_t count_;
  std::vector<Triangle> hull_;  // facets without a neighbor
};

}  // namespace

Fault find_fault(const TetrahedraView& arrays, unsigned threads, const Monitor& monitor) {
  return Checker(arrays, threads, monitor).run();
}

}  // namespace vorotool::core::tetrahedra
