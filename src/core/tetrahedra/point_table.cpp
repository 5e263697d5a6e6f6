#include "core/tetrahedra/point_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include "core/base/groups.hpp"
#include "core/base/indices.hpp"
#include "core/base/large_array.hpp"
#include "core/base/parallel.hpp"
#include "core/numbers/sign.hpp"
#include "core/tetrahedra/exact_measures.hpp"
#include "core/tetrahedra/predicates.hpp"
#include "core/tetrahedra/spheres.hpp"

namespace vorotool::core::tetrahedra {

using base::at;
using base::Monitor;
using numbers::unit_roundoff;

namespace {

using Corners = std::array<std::int32_t, 4>;

constexpr std::size_t items_a_piece = std::size_t{1} << 12;

// The nearest of points that are seen again and again.
class Nearest {
 public:
  Nearest(std::span<const Point3> points, std::span<const std::int64_t> labels)
      : points_(points), labels_(labels) {}

  void begin(std::size_t from) {
    from_ = static_cast<std::int32_t>(from);
    least_ = std::numeric_limits<double>::infinity();
    keeps_all_ = false;
    close_.clear();
  }

  // A square errs by 7 u of itself at most, if nothing underflows or overflows: what is farther by 16 u than another
  // is not the nearest.
  void meet(std::int32_t v) {
    if (v == from_) return;
    const Point3 &p = points_[at(from_)], &q = points_[at(v)];
    const double x = q.x - p.x, y = q.y - p.y, z = q.z - p.z, square = x * x + y * y + z * z;
    if (square > 0x1p-900 && square < 0x1p1000) {
      if (square > least_ * (1 + 16 * unit_roundoff)) return;
      if (!keeps_all_ && square < least_ * (1 - 16 * unit_roundoff)) close_.clear();
      least_ = std::min(least_, square);
    } else {
      keeps_all_ = true;
    }
    if (std::find(close_.begin(), close_.end(), v) == close_.end()) close_.push_back(v);
  }

  std::int32_t found() const {
    std::int32_t best = -1;
    for (const std::int32_t v : close_) {
      if (best < 0 || is_before(v, best)) best = v;
    }
    return best;
  }

 private:
  bool is_before(std::int32_t v, std::int32_t w) const {
    const int order = compare_distances(points_[at(from_)], points_[at(v)], points_[at(w)]);
    if (order != 0) return order < 0;
    return labels_[at(v)] != labels_[at(w)] ? labels_[at(v)] < labels_[at(w)] : v < w;
  }

  std::span<const Point3> points_;
  std::span<const std::int64_t> labels_;
  std::int32_t from_ = 0;
  double least_ = 0;
  bool keeps_all_ = false;           // once a square may be wrong
  std::vector<std::int32_t> close_;  // each once, and the nearest among them
};

// The corners of simplices at each point, numbered through all simplices of so many corners. Points come in the order in
// which simplices first have them, so that those near each other come together.
template <std::size_t corners>
class Stars {
 public:
  using Simplex = std::array<std::int32_t, corners>;

  Stars(std::span<const Point3> points, std::span<const Simplex> simplices)
      : points_(points.size()), simplices_(simplices), stars_(group()) {}

  // Calls body(point, its star) for points that have one, from several threads; `make_body` makes one for each piece.
  template <class MakeBody>
  void for_points(unsigned threads, const Monitor& monitor, const MakeBody& make_body) const {
    const auto run = [&](std::size_t, std::size_t begin, std::size_t end) {
      auto body = make_body();
      for (std::size_t i = begin; i < end; ++i) body(at(order_[i]), stars_[i]);
    };
    base::for_pieces(order_.size(), items_a_piece, threads, monitor, run);
  }

 private:
  base::Groups<std::uint32_t> group() {
    std::vector<std::int32_t> place(points_, base::no_index);
    for (const Simplex& simplex : simplices_) {
      base::check_range(simplex, 0, points_, "a simplex names a point that does not exist");
      for (const std::int32_t v : simplex) {
        if (place[at(v)] != base::no_index) continue;
        place[at(v)] = static_cast<std::int32_t>(order_.size());
        order_.push_back(v);
      }
    }
    return {order_.size(), [&](const auto& add) {
              std::uint32_t number = 0;
              for (const Simplex& simplex : simplices_) {
                for (const std::int32_t v : simplex) add(place[at(v)], number++);
              }
            }};
  }

  std::size_t points_;
  std::span<const Simplex> simplices_;
  std::vector<std::int32_t> order_;
  base::Groups<std::uint32_t> stars_;
};

// The three corners opposite to each corner of a tetrahedron, which are a positive tetrahedron with it.
constexpr std::array<std::array<std::size_t, 3>, 4> opposite{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

// Centers of the spheres of tetrahedra.
class Centers {
 public:
  Centers(std::span<const Point3> points, std::span<const Corners> tetrahedra, unsigned threads,
          const Monitor& monitor)
      : points_(points), tetrahedra_(tetrahedra), spheres_(tetrahedra.size()) {
    base::for_items(tetrahedra.size(), items_a_piece, threads, monitor, [&](std::size_t t) {
      const auto& [a, b, c, d] = tetrahedra[t];
      const Sphere sphere = sphere_of({points[at(a)], points[at(b)], points[at(c)], points[at(d)]});
      spheres_[t] = {sphere.way, sphere.error};
    });
  }

  struct Center {
    Point3 way;  // from a corner
    double radius, error;

    Center(const Point3& way, double error)
        : way(way), radius(std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z)), error(error) {}
  };

  // The error is that of the way from the first corner: 3 u of the radius come to it.
  Center from(const Point3& corner, std::size_t t) const {
    const auto& [way, error] = spheres_[t];
    const Point3& first = points_[at(tetrahedra_[t][0])];
    const Point3 to{way.x - (corner.x - first.x), way.y - (corner.y - first.y), way.z - (corner.z - first.z)};
    return {to, error};
  }

 private:
  struct Known {
    Point3 way;
    double error;
  };

  std::span<const Point3> points_;
  std::span<const Corners> tetrahedra_;
  base::LargeArray<Known> spheres_;
};

// Volumes of cells. The part of the surface of a cell between its site and an edge of its face, which is half-way to
// another point u, is the sixth of a determinant of half the way to u and those to the ends p, q of the edge. An edge
// is of two faces, half-way to b and c, which it goes round in opposite directions: p x q (c - b) / 12.
class Cells {
 public:
  Cells(std::span<const Point3> points, std::span<const Corners> tetrahedra,
        std::span<const Corners> neighbors, const Centers& centers)
      : points_(points), tetrahedra_(tetrahedra), neighbors_(neighbors), centers_(centers) {}

  struct Measure {
    std::size_t hull_sides = 0;  // at the point
    double volume = 0;           // infinite on the hull
  };

  // Meets all corners of the star.
  Measure measure(std::size_t v, std::span<const std::uint32_t> star, Nearest& nearest) const {
    Measure result;
    Sum sum;
    const Point3& site = points_[v];
    for (const std::uint32_t& corner : star) {
      const auto center = centers_.from(site, corner / 4);
      for_faces({&corner, 1}, [&](std::size_t t, std::int32_t other, std::int32_t b, std::int32_t c) {
        nearest.meet(b);
        if (other < 0) ++result.hull_sides;
        if (other >= 0 && at(other) > t)
          sum.add(center, centers_.from(site, at(other)), points_[at(b)], points_[at(c)]);
      });
    }
    if (result.hull_sides > 0) {
      result.volume = std::numeric_limits<double>::infinity();
    } else {
      result.volume = sum.is_close() ? sum.twelve_volumes / 12 : careful_volume(v, star);
    }
    return result;
  }

 private:
  // The errors of p and q count with 3 u of the radii each, the cross product with 4 u, the last with another 4 u:
  // 20 u of all magnitudes cover the higher terms, and the roundings of the bound but for 2^-20 of it.
  struct Sum {
    double twelve_volumes = 0, error = 0;

    void add(const Centers::Center& p, const Centers::Center& q, const Point3& b, const Point3& c) {
      const double x = c.x - b.x, y = c.y - b.y, z = c.z - b.z,
                   side = std::abs(x) + std::abs(y) + std::abs(z);
      const Point3 &u = p.way, &v = q.way;
      twelve_volumes +=
          (u.y * v.z - u.z * v.y) * x + (u.z * v.x - u.x * v.z) * y + (u.x * v.y - u.y * v.x) * z;
      error += side * (p.error * q.radius + q.error * p.radius + 20 * unit_roundoff * p.radius * q.radius) +
               unit_roundoff * std::abs(twelve_volumes);
      if (!(side < 0x1p200)) error = std::numeric_limits<double>::infinity();
    }

    // Products that underflow lose less than 2^-1074 2^200 in each of 2^30 terms.
    bool is_close() const {
      return twelve_volumes > 0x1p-800 && twelve_volumes < 0x1p900 && error <= 0x1p-41 * twelve_volumes;
    }
  };

  // Calls body(tetrahedron, the one across a face at v, the other two corners of the face: counter-clockwise as seen
  // from the last corner of the tetrahedron).
  template <class Body>
  void for_faces(std::span<const std::uint32_t> star, const Body& body) const {
    for (const std::size_t corner : star) {
      const std::size_t t = corner / 4;
      const Corners &row = tetrahedra_[t], &across = neighbors_[t];
      const auto [b, c, d] = opposite[corner % 4];
      body(t, across[d], row[b], row[c]);
      body(t, across[b], row[c], row[d]);
      body(t, across[c], row[d], row[b]);
    }
  }

  // With better centers, or by integers.
  double careful_volume(std::size_t v, std::span<const std::uint32_t> star) const {
    std::vector<std::array<Point3, 3>> ends;
    std::vector<Centers::Center> centers;
    for (const std::uint32_t corner : star) {
      const Corners& row = tetrahedra_[corner / 4];
      const auto [b, c, d] = opposite[corner % 4];
      ends.push_back({points_[at(row[b])], points_[at(row[c])], points_[at(row[d])]});
      const Sphere sphere = sphere_of({points_[v], ends.back()[0], ends.back()[1], ends.back()[2]}, 0x1p-50);
      centers.emplace_back(sphere.way, sphere.error);
    }
    Sum sum;
    const std::vector<CellEdge> edges = edges_of(star);
    for (const CellEdge& edge : edges) sum.add(centers[edge.first], centers[edge.second], edge.b, edge.c);
    return sum.is_close() ? sum.twelve_volumes / 12 : exact_cell_volume(points_[v], ends, edges);
  }

  std::vector<CellEdge> edges_of(std::span<const std::uint32_t> star) const {
    const auto number_of = [&](std::size_t t) {
      const auto found = std::lower_bound(star.begin(), star.end(), 4 * t);
      if (found == star.end() || *found / 4 != t)
        throw std::invalid_argument("a neighbor does not share the face");
      return static_cast<std::uint32_t>(found - star.begin());
    };
    std::vector<CellEdge> edges;
    for_faces(star, [&](std::size_t t, std::int32_t other, std::int32_t b, std::int32_t c) {
      if (at(other) > t)
        edges.push_back({number_of(t), number_of(at(other)), points_[at(b)], points_[at(c)]});
    });
    return edges;
  }

  std::span<const Point3> points_;
  std::span<const Corners> tetrahedra_, neighbors_;
  const Centers& centers_;
};

}  // namespace

PointTable point_table(std::span<const Point3> points, std::span<const Corners> tetrahedra,
                       std::span<const Corners> neighbors, std::span<const std::int64_t> labels,
                       unsigned threads, const Monitor& monitor) {
  for (const Corners& row : neighbors)
    base::check_range(row, -1, tetrahedra.size(), "a neighbor is no tetrahedron");
  const Stars<4> stars(points, tetrahedra);
  const Monitor first = base::part_of(monitor, 0.2, 0.5);
  const Monitor second = base::part_of(monitor, 0.5, 1);
  const Centers centers(points, tetrahedra, threads, first);
  const Cells cells(points, tetrahedra, neighbors, centers);
  const std::size_t n = points.size();
  PointTable result{std::vector<std::int32_t>(n), std::vector<double>(n), std::vector<std::int32_t>(n, -1),
                    std::vector<std::uint8_t>(n)};
  stars.for_points(threads, second, [&] {
    return
        [&, nearest = Nearest(points, labels)](std::size_t v, std::span<const std::uint32_t> star) mutable {
          nearest.begin(v);
          const auto [sides, volume] = cells.measure(v, star, nearest);
          result.nearest[v] = nearest.found();
          result.on_hull[v] = sides > 0;
          // By Euler's relation: the triangles around a point are a sphere, or a disk with so many edges around it.
          const std::size_t degree = sides > 0 ? 1 + (star.size() + sides) / 2 : 2 + star.size() / 2;
          result.neighbors[v] = static_cast<std::int32_t>(degree);
          result.cell_volume[v] = volume;
        };
  });
  return result;
}

template <std::size_t corners>
std::vector<std::int32_t> nearest_corners(std::span<const Point3> points,
                                          std::span<const std::array<std::int32_t, corners>> simplices,
                                          std::span<const std::int64_t> labels, unsigned threads,
                                          const Monitor& monitor) {
  std::vector<std::int32_t> result(points.size(), -1);
  Stars<corners>(points, simplices).for_points(threads, monitor, [&] {
    return
        [&, nearest = Nearest(points, labels)](std::size_t v, std::span<const std::uint32_t> star) mutable {
          nearest.begin(v);
          for (const std::size_t corner : star) {
            for (const std::int32_t w : simplices[corner / corners]) nearest.meet(w);
          }
          result[v] = nearest.found();
        };
  });
  return result;
}

template std::vector<std::int32_t> nearest_corners(std::span<const Point3>,
                                                   std::span<const std::array<std::int32_t, 2>>,
                                                   std::span<const std::int64_t>, unsigned, const Monitor&);
template std::vector<std::int32_t> nearest_corners(std::span<const Point3>,
                                                   std::span<const std::array<std::int32_t, 3>>,
                                                   std::span<const std::int64_t>, unsigned, const Monitor&);

}  // namespace vorotool::core::tetrahedra
