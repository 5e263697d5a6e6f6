#include "core/offsets/offset_curves.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include "core/kernel/lattice.hpp"
#include "core/numbers/elementary.hpp"
#include "core/offsets/inner_components.hpp"

namespace vorotool::core::offsets {

using base::Monitor;
using kernel::Point;
using skeleton::LatticeToInput;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// From one direction to another, counter-clockwise and by at most half a turn.
double angle(const Point& a, const Point& b) {
  if (cross(a, b) > 0) return numbers::angle_of(dot(a, b), cross(a, b));
  return dot(a, b) < 0 ? std::numbers::pi : 0;
}

// A piece of a curve, what is near on its left: across the cell to the right of the first half-edge, which is
// to the left of the last one.
struct Piece {
  HalfEdge first, last;
};

// A ring of pieces, or the whole circle about a point.
struct Ring {
  std::vector<Piece> pieces;
  std::int32_t point = -1;
};

class CurveMaker {
 public:
  CurveMaker(const HalfEdges& borders, const PolygonFaces& domain, double distance,
             const LatticeToInput& place, const Monitor& monitor)
      : borders_(borders),
        diagram_(borders.diagram()),
        domain_(domain),
        distance_(distance),
        place_(place),
        monitor_(monitor),
        level_(borders, distance / place.scale),
        far_(borders, domain, level_, monitor),
        crossings_(borders, domain, level_, far_, monitor),
        near_(borders, domain, level_, crossings_, monitor),
        is_lone_(diagram_.points.size(), true) {
    for (const auto& ends : diagram_.segments) {
      for (const std::int32_t end : ends) is_lone_[static_cast<std::size_t>(end)] = false;
    }
    walk_rings();
    add_circles();
  }

  OffsetCurves make() {
    curves_.ring_start.push_back(0);
    curves_.shape_start.push_back(0);
    for (const Shape& shape : shapes()) write_shape(shape);
    return std::move(curves_);
  }

 private:
  struct Shape {
    std::int32_t polygon;
    std::vector<std::size_t> rings;  // the outer one first
  };

  void add(Ring&& ring, std::int32_t far_vertex, std::int32_t site, std::int32_t polygon) {
    rings_.push_back(std::move(ring));
    sides_.push_back({far_.of(far_vertex), near_.of(site)});
    inner_polygon_.push_back(polygon);
  }

  void walk_rings() {
    std::vector<bool> is_done(crossings_.all().size());
    for (const HalfEdge first : crossings_.all()) {
      if (is_done[crossings_.number(first)]) continue;
      base::report(monitor_, 0);
      Ring ring;
      HalfEdge h = first;
      do {
        is_done[crossings_.number(h)] = true;
        ring.pieces.push_back({h, crossings_.across_cell(h)});
        h = crossings_.onward(ring.pieces.back().last);
      } while (h != first);
      add(std::move(ring), borders_.tail(first), borders_.right(first), domain_.polygon_at(borders_, first));
    }
  }

  // About points without segments whose cells are around the whole curve.
  void add_circles() {
    if (std::find(is_lone_.begin(), is_lone_.end(), true) == is_lone_.end()) return;
    std::vector<HalfEdge> border(is_lone_.size(), no_edge);
    std::vector<bool> is_free(is_lone_.begin(), is_lone_.end());
    for (HalfEdge h = 0; h < borders_.size(); ++h) {
      if (!diagram_.is_point(borders_.left(h))) continue;
      const auto point = static_cast<std::size_t>(borders_.left(h));
      border[point] = h;
      if (!level_.is_edge_above(h)) is_free[point] = false;
    }
    for (std::size_t p = 0; p < is_free.size(); ++p) {
      if (!is_free[p]) continue;
      const HalfEdge h = border[p];
      if (h == no_edge ? !domain_.is_outward : !domain_.holds(borders_, h)) continue;
      const auto point = static_cast<std::int32_t>(p);
      add({{}, point}, h == no_edge ? -1 : borders_.tail(h), point,
          h == no_edge ? -1 : domain_.polygon_at(borders_, h));
    }
  }

  // By their polygons, those of several last.
  std::vector<Shape> shapes() {
    if (rings_.empty()) return {};
    const std::int32_t outside = domain_.is_outward ? far_.of(-1) : near_.of(site_outside());
    const std::vector<bool> is_outer = outer_rings(sides_, outside, domain_.is_outward);
    const std::vector<std::int32_t> of_region =
        domain_.is_outward ? region_polygons() : std::vector<std::int32_t>();
    std::vector<std::pair<std::int32_t, std::size_t>> order;  // region of the shape, and ring
    for (std::size_t k = 0; k < rings_.size(); ++k)
      order.emplace_back(domain_.is_outward ? sides_[k].near : sides_[k].far, k);
    std::stable_sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
      return a.first != b.first ? a.first < b.first : is_outer[a.second] > is_outer[b.second];
    });
    std::vector<Shape> shapes;
    for (const auto& [region, ring] : order) {
      if (is_outer[ring]) {
        shapes.push_back(
            {domain_.is_outward ? of_region[static_cast<std::size_t>(region)] : inner_polygon_[ring], {}});
      }
      shapes.back().rings.push_back(ring);
    }
    std::stable_sort(shapes.begin(), shapes.end(), [](const Shape& a, const Shape& b) {
      const auto rank = [](const Shape& s) {
        return std::pair(static_cast<std::uint32_t>(s.polygon), s.rings[0]);
      };
      return rank(a) < rank(b);
    });
    return shapes;
  }

  // Something that is bounded lies inside, so that there is an unbounded edge.
  std::int32_t site_outside() const {
    HalfEdge h = 0;
    while (borders_.tail(h) >= 0) ++h;
    return borders_.left(h);
  }

  // [n + m] at the number of each region, its first polygon; -1 if it is of several features.
  std::vector<std::int32_t> region_polygons() {
    constexpr std::int32_t unknown = -2;
    const std::size_t sites = domain_.site_polygon.size();
    std::vector<std::int32_t> polygon(sites, unknown), feature(sites, unknown);
    for (std::size_t s = 0; s < sites; ++s) {
      const auto region = static_cast<std::size_t>(near_.of(static_cast<std::int32_t>(s)));
      const std::int32_t own = domain_.site_polygon[s];
      if (feature[region] == unknown) {
        polygon[region] = own;
        feature[region] = domain_.site_feature[s];
      } else if (feature[region] == domain_.site_feature[s]) {
        polygon[region] = std::min(polygon[region], own);
      } else {
        polygon[region] = feature[region] = -1;
      }
    }
    return polygon;
  }

  // A ring that rounding leaves nothing of is left out, and with it what is inside it.
  void write_shape(const Shape& shape) {
    for (const std::size_t ring : shape.rings) {
      const std::size_t first = curves_.site.size();
      if (rings_[ring].point >= 0) {
        write_circle(rings_[ring].point);
      } else {
        write_ring(rings_[ring].pieces);
      }
      const std::size_t count = curves_.site.size() - first;
      if (count > 2 ||
          (count == 2 && !(std::isnan(curves_.centre[first].x) && std::isnan(curves_.centre[first + 1].x)))) {
        curves_.ring_start.push_back(static_cast<std::int64_t>(first + count));
        continue;
      }
      curves_.start.resize(first);
      curves_.end.resize(first);
      curves_.centre.resize(first);
      curves_.site.resize(first);
      if (ring == shape.rings[0]) return;
    }
    curves_.shape_start.push_back(static_cast<std::int64_t>(curves_.ring_start.size() - 1));
    curves_.shape_polygon.push_back(shape.polygon);
  }

  void write_circle(std::int32_t point) {
    const Point centre = place_(centre_of(point));
    const Point right{centre.x + distance_, centre.y}, left{centre.x - distance_, centre.y};
    write_piece(right, left, centre, point);
    write_piece(left, right, centre, point);
  }

  // Inwards the shape is what is far: the other way round.
  void write_ring(const std::vector<Piece>& ring) {
    for (const Piece& piece : ring) {
      if (is_empty(piece))
        crossings_.place(crossings_.onward(piece.last)) = crossings_.place(piece.last) =
            crossings_.place(piece.first);
    }
    for (std::size_t i = 0; i < ring.size(); ++i)
      write_between(ring[domain_.is_outward ? i : ring.size() - 1 - i]);
  }

  // Between two segments on one line, their common end has no arc; nor where rounding leaves nothing of it.
  bool is_empty(const Piece& piece) {
    const auto& [first, last] = piece;
    const std::int32_t site = borders_.left(last);
    if (!diagram_.is_point(site)) return false;
    if (domain_.is_own_end(first) && domain_.is_own_end(last) &&
        borders_.left(first) != borders_.right(last)) {
      const kernel::LatticeSite one = diagram_.site(borders_.left(first)),
                                other = diagram_.site(borders_.right(last));
      if (core::kernel::cross(one.b - one.a, other.b - other.a) == 0) return true;
    }
    const Point a = crossings_.place(first) - centre_of(site), b = crossings_.place(last) - centre_of(site);
    return dot(a, b) > 0 && cross(a, b) <= 0 && !(is_lone(site) && turn(piece) > std::numbers::pi);
  }

  void write_between(const Piece& piece) {
    const auto& [first, last] = piece;
    const std::int32_t site = borders_.left(last);
    const Point start = place_(crossings_.place(first)), end = place_(crossings_.place(last));
    if (!diagram_.is_point(site)) {
      write_directed(start, end, {nan, nan}, site);
      return;
    }
    const Point centre = place_(centre_of(site));
    // only about points without segments arcs are over half a circle
    if (!is_lone(site) || turn(piece) < 3) {
      write_directed(start, end, centre, site);
      return;
    }
    const Point middle = place_(opposite(piece));
    const std::pair<Point, Point> halves[2] = {{start, middle}, {middle, end}};
    for (const auto& half : {halves[domain_.is_outward ? 0 : 1], halves[domain_.is_outward ? 1 : 0]}) {
      write_directed(half.first, half.second, centre, site);
    }
  }

  // The middle of a long arc: across its chord, or where that is short away from its ends.
  Point opposite(const Piece& piece) {
    const Point centre = centre_of(borders_.left(piece.last));
    const Point a = crossings_.place(piece.first) - centre, b = crossings_.place(piece.last) - centre;
    const Point across = dot(a, b) > 0 ? Point{-a.x - b.x, -a.y - b.y} : Point{b.y - a.y, a.x - b.x};
    const double part = distance_ / place_.scale / std::sqrt(dot(across, across));
    return {centre.x + part * across.x, centre.y + part * across.y};
  }

  // How far the curve turns about a point of its own: as its cell does between both ends. Sums of rounded
  // angles tell a small turn from a whole one.
  double turn(const Piece& piece) {
    const auto [first, last] = piece;
    const Point centre = centre_of(borders_.left(last));
    Point before = crossings_.place(first) - centre;
    double sum = 0;
    const auto go_to = [&](const Point& direction) {
      sum += angle(before, direction);
      before = direction;
    };
    HalfEdge h = first ^ 1;
    do {
      const std::int32_t head = borders_.head(h);
      if (head < 0) go_to(borders_.way(h));
      h = borders_.next(h);
      const Point in =
          head < 0 ? borders_.way(h) : centre - diagram_.vertices[static_cast<std::size_t>(head)];
      go_to({-in.x, -in.y});
    } while (h != last);
    go_to(crossings_.place(last) - centre);
    return sum;
  }

  void write_directed(const Point& start, const Point& end, const Point& centre, std::int32_t site) {
    if (start == end) return;
    domain_.is_outward ? write_piece(start, end, centre, site) : write_piece(end, start, centre, site);
  }

  void write_piece(const Point& start, const Point& end, const Point& centre, std::int32_t site) {
    curves_.start.push_back(start);
    curves_.end.push_back(end);
    curves_.centre.push_back(centre);
    curves_.site.push_back(site);
  }

  bool is_lone(std::int32_t point) const { return is_lone_[static_cast<std::size_t>(point)]; }
  Point centre_of(std::int32_t point) const {
    return {static_cast<double>(diagram_.point(point).x), static_cast<double>(diagram_.point(point).y)};
  }

  const HalfEdges& borders_;
  const segment_voronoi::build::DiagramView& diagram_;
  const PolygonFaces& domain_;
  double distance_;
  const LatticeToInput& place_;
  const Monitor& monitor_;
  LevelSet level_;
  OuterComponents far_;
  LevelCrossings crossings_;
  InnerComponents near_;
  std::vector<bool> is_lone_;  // [n] whether no segment ends there
  std::vector<Ring> rings_;
  std::vector<RingSides> sides_;             // of the rings
  std::vector<std::int32_t> inner_polygon_;  // of the rings: the polygon around what is far, -1 outside
  OffsetCurves curves_;
};

}  // namespace

OffsetCurves offset_curves(const HalfEdges& borders, const PolygonFaces& domain, double distance,
                           const LatticeToInput& place, const Monitor& monitor) {
  return CurveMaker(borders, domain, distance, place, monitor).make();
}

}  // namespace vorotool::core::offsets
