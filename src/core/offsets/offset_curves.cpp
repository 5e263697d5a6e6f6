#include "core/offsets/offset_curves.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/numbers/special_values.hpp"
#include "core/offsets/inner_components.hpp"
#include "core/offsets/level_arcs.hpp"

namespace vorotool::core::offsets {

using base::Monitor;
using kernel::Point;
using numbers::nan;
using skeleton::LatticeToInput;

namespace {

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
        arcs_(borders, crossings_, distance / place.scale) {
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

  void add_circles() {
    for (const auto& [point, h] : arcs_.circles(domain_, level_)) {
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
          (count == 2 && !(std::isnan(curves_.center[first].x) && std::isnan(curves_.center[first + 1].x)))) {
        curves_.ring_start.push_back(static_cast<std::int64_t>(first + count));
        continue;
      }
      curves_.start.resize(first);
      curves_.end.resize(first);
      curves_.center.resize(first);
      curves_.site.resize(first);
      if (ring == shape.rings[0]) return;
    }
    curves_.shape_start.push_back(static_cast<std::int64_t>(curves_.ring_start.size() - 1));
    curves_.shape_polygon.push_back(shape.polygon);
  }

  void write_circle(std::int32_t point) {
    const Point center = place_(arcs_.center_of(point));
    const Point right{center.x + distance_, center.y}, left{center.x - distance_, center.y};
    write_piece(right, left, center, point);
    write_piece(left, right, center, point);
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

  bool is_empty(const Piece& piece) const {
    return arcs_.is_between_aligned(domain_, piece) || arcs_.is_lost(piece);
  }

  void write_between(const Piece& piece) {
    const auto& [first, last] = piece;
    const std::int32_t site = arcs_.site(piece);
    const Point start = place_(crossings_.place(first)), end = place_(crossings_.place(last));
    if (!diagram_.is_point(site)) {
      write_directed(start, end, {nan, nan}, site);
      return;
    }
    const Point center = place_(arcs_.center_of(site));
    if (!arcs_.is_long(piece)) {
      write_directed(start, end, center, site);
      return;
    }
    const Point middle = place_(arcs_.middle(piece));
    const std::pair<Point, Point> halves[2] = {{start, middle}, {middle, end}};
    for (const auto& half : {halves[domain_.is_outward ? 0 : 1], halves[domain_.is_outward ? 1 : 0]}) {
      write_directed(half.first, half.second, center, site);
    }
  }

  void write_directed(const Point& start, const Point& end, const Point& center, std::int32_t site) {
    if (start == end) return;
    domain_.is_outward ? write_piece(start, end, center, site) : write_piece(end, start, center, site);
  }

  void write_piece(const Point& start, const Point& end, const Point& center, std::int32_t site) {
    curves_.start.push_back(start);
    curves_.end.push_back(end);
    curves_.center.push_back(center);
    curves_.site.push_back(site);
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
  LevelArcs arcs_;
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
