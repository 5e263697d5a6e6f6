#include "core/cells/voronoi_cells.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <stdexcept>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/delaunay/vertex_triangles.hpp"
#include "core/kernel/circumcenter.hpp"
#include "core/kernel/predicates.hpp"

namespace vorotool::core::cells {

using base::for_pieces;
using base::Monitor;
using delaunay::TriangulationArrays;
using kernel::Point;

namespace {

using Index = std::int32_t;

constexpr std::size_t sites_a_piece = std::size_t{1} << 12;
constexpr std::size_t triangles_a_piece = std::size_t{1} << 14;

bool same_place(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }

// The frame.

// Sides and corners are numbered counter-clockwise: side s goes from corner s to corner s + 1, side 0 is the
// bottom, corner 0 the left end of it.
constexpr int sides = 4;
using SideSet = unsigned;  // a bit a side
constexpr SideSet all_sides = 15;
constexpr SideSet side_bit(int side) { return 1U << side; }

// Every decision about the frame is made as if each side lay farther out by an infinitely small distance,
// that of the left and right sides infinitely larger than that of the others. So no vertex lies on the frame,
// no edge along it or through a corner of it, and all decisions fit together. What is rounded afterwards is
// the place itself.
class Frame {
 public:
  explicit Frame(const Box& box)
      : box_{box.left + 0.0, box.bottom + 0.0, box.right + 0.0, box.top + 0.0},  // no negative zeros
        corners_{Point{box_.left, box_.bottom},
                 {box_.right, box_.bottom},
                 {box_.right, box_.top},
                 {box_.left, box_.top}} {}

  const Point& corner(int k) const { return corners_[static_cast<std::size_t>(k % sides)]; }

  // The sides beyond which a place lies: only places beyond the frame are. `exact` gives the place with signs
  // of all its errors, which a coordinate on a side may need.
  template <class Exact>
  SideSet beyond(kernel::RoundedPoint place, Exact exact) const {
    if (is_open(place.x, box_.left, box_.right) || is_open(place.y, box_.bottom, box_.top)) place = exact();
    return (place.y.compare(box_.bottom) < 0 ? side_bit(0) : 0) |
           (place.x.compare(box_.right) > 0 ? side_bit(1) : 0) |
           (place.y.compare(box_.top) > 0 ? side_bit(2) : 0) |
           (place.x.compare(box_.left) < 0 ? side_bit(3) : 0);
  }

  // The sides beyond which one gets from a place on the way in a direction.
  static SideSet far_beyond(SideSet from, double dx, double dy) {
    SideSet result = 0;
    result |= dy < 0 ? side_bit(0) : dy > 0 ? side_bit(2) : from & (side_bit(0) | side_bit(2));
    result |= dx < 0 ? side_bit(3) : dx > 0 ? side_bit(1) : from & (side_bit(1) | side_bit(3));
    return result;
  }

  // Whether corner k is nearer to a than to b; as far out as it is taken to lie, the distances differ.
  bool is_nearer(int k, const Point& a, const Point& b) const {
    k %= sides;
    if (const int order = kernel::compare_distances(corner(k), a, b); order != 0) return order < 0;
    const bool is_right = k == 1 || k == 2, is_top = k >= 2;
    if (a.x != b.x) return (a.x > b.x) == is_right;
    return (a.y > b.y) == is_top;
  }

  // Where the bisector of a and b crosses a side, if it does.
  Point crossing(int side, const Point& a, const Point& b) const {
    const Point& start = corner(side);
    if (side % 2 == 1) return {start.x, kernel::bisector_at(start.x, a, b) + 0.0};
    return {kernel::bisector_at(start.y, {a.y, a.x}, {b.y, b.x}) + 0.0, start.y};
  }

 private:
  static bool is_open(const numbers::Rounded& value, double low, double high) {
    return value.error_sign == numbers::undecided && (value.value == low || value.value == high);
  }

  Box box_;
  std::array<Point, 4> corners_;
};

// One cell.

// A vertex of the diagram, or an end at infinity of an edge, beyond some sides of the frame.
struct Stop {
  SideSet beyond;
  Point place;  // only where it is in the frame
};

// Puts together the ring of a site's cell from the edges of the Voronoi diagram around it, counter-clockwise.
//
// Where the cell's boundary leaves the frame through a side and comes back through another one, the frame's
// corners between them belong to the cell. Through the same side, none does: a cell with all four corners
// would, being convex, hold the frame.
class CellTracer {
 public:
  explicit CellTracer(const Frame& frame) : frame_(frame) {}

  void begin(const Point& site) {
    site_ = site;
    ring_.clear();
    entered_ = left_ = -1;
  }

  // The edge between two vertices, at which the cell of `other` begins.
  void add_edge(const Stop& from, const Stop& to, const Point& other) {
    if (from.beyond & to.beyond) return;
    const SideSet changing = from.beyond ^ to.beyond;
    const bool inside = from.beyond == 0 || enter(changing, other);
    if (to.beyond == 0) {
      ring_.push_back(to.place);
    } else if (inside) {
      leave(changing, other);
    }
  }

  // An edge that is a whole line, between two of the collinear sites.
  void add_line(const Point& other) {
    if (enter(all_sides, other)) leave(all_sides, other);
  }

  // The ring; empty if the cell and the frame have nothing in common or one is in the other without meeting
  // it.
  const std::vector<Point>& end() {
    if (entered_ >= 0 && left_ >= 0) add_corners(left_, entered_);
    return ring_;
  }

 private:
  // Comes in through the side that the edge crosses inwards, if there is one.
  bool enter(SideSet candidates, const Point& other) {
    const int side = side_crossed(candidates, other, true);
    if (side < 0) return false;
    if (left_ >= 0) {
      add_corners(left_, side);
    } else {
      entered_ = side;
    }
    ring_.push_back(frame_.crossing(side, site_, other));
    return true;
  }

  void leave(SideSet candidates, const Point& other) {
    left_ = side_crossed(candidates, other, false);
    if (left_ < 0) throw std::invalid_argument("the circumcenters around a point do not go round it");
    ring_.push_back(frame_.crossing(left_, site_, other));
  }

  // Along a side, counter-clockwise, the cell ends where its boundary comes in, and begins where it goes out.
  int side_crossed(SideSet candidates, const Point& other, bool inwards) const {
    for (int side = 0; side < sides; ++side) {
      if ((candidates & side_bit(side)) == 0) continue;
      const bool first = frame_.is_nearer(side, site_, other);
      if (first == inwards && first != frame_.is_nearer(side + 1, site_, other)) return side;
    }
    return -1;
  }

  void add_corners(int from, int to) {
    for (int side = from; side != to; side = (side + 1) % sides) ring_.push_back(frame_.corner(side + 1));
  }

  const Frame& frame_;
  Point site_{};
  std::vector<Point> ring_;
  int entered_ = -1,
      left_ = -1;  // sides: the first one through which the boundary comes in; the last one out
};

// Takes out vertices that are at the place of the one before; leaves nothing of a ring without area. The
// first vertex becomes the smallest.
void tidy(std::vector<Point>& ring) {
  ring.erase(std::unique(ring.begin(), ring.end(), same_place), ring.end());
  while (ring.size() > 1 && same_place(ring.front(), ring.back())) ring.pop_back();
  std::size_t k = 2;
  while (k < ring.size() && kernel::orient2d(ring[0], ring[1], ring[k]) == 0) ++k;
  if (k >= ring.size()) ring.clear();
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end(), kernel::lexicographic_less<Point>),
              ring.end());
}

// All cells.

class CellMaker {
 public:
  CellMaker(const TriangulationArrays& mesh, const Box& frame, unsigned threads, const Monitor& monitor)
      : mesh_(mesh),
        rings_(mesh),
        frame_(frame),
        threads_(threads),
        monitor_(monitor),
        stops_(mesh.triangles.size() / 3) {}

  VoronoiCells run() {
    const bool chain = stops_.size() == 0;
    place_stops();
    const std::span<const Index> order = chain ? mesh_.hull : rings_.order();
    pieces_.resize(base::piece_count(order.size(), sites_a_piece));
    starts_.assign(mesh_.points.size() + 1, 0);
    for_pieces(order.size(), sites_a_piece, threads_, monitor_,
               [&](std::size_t piece, std::size_t begin, std::size_t end) {
                 trace_piece(order, piece, begin, end, chain);
               });
    if (!order.empty() && !any_.load()) give_frame_to_nearest(order);
    return gather(order);
  }

 private:
  const Point& at(Index v) const { return mesh_.points[static_cast<std::size_t>(v)]; }

  void place_stops() {
    base::for_items(stops_.size(), triangles_a_piece, threads_, monitor_,
                    [&](std::size_t t) { stops_[t] = stop_of(&mesh_.triangles[3 * t]); });
  }

  Stop stop_of(const Index* corners) const {
    const Point &a = at(corners[0]), &b = at(corners[1]), &c = at(corners[2]);
    if (kernel::orient2d(a, b, c) <= 0) throw std::invalid_argument("a triangle is not counter-clockwise");
    const kernel::RoundedPoint center = kernel::circumcenter(a, b, c);
    const SideSet beyond = frame_.beyond(center, [&] { return kernel::circumcenter_exactly(a, b, c); });
    return {beyond, {center.x.value + 0.0, center.y.value + 0.0}};  // no negative zeros
  }

  void trace_piece(std::span<const Index> order, std::size_t piece, std::size_t begin, std::size_t end,
                   bool chain) {
    CellTracer tracer(frame_);
    std::vector<Spoke> spokes;
    std::vector<Point> vertices, ring;
    for (std::size_t i = begin; i < end; ++i) {
      tracer.begin(at(order[i]));
      if (chain) {
        add_lines(i, tracer);
      } else {
        add_edges(order[i], spokes, tracer);
      }
      ring = tracer.end();
      if (!ring.empty()) any_.store(true, std::memory_order_relaxed);
      tidy(ring);
      vertices.insert(vertices.end(), ring.begin(), ring.end());
      starts_[static_cast<std::size_t>(order[i]) + 1] = static_cast<std::int64_t>(ring.size());
    }
    pieces_[piece] = std::move(vertices);
  }

  // A triangle at a site, with the two other corners.
  struct Spoke {
    Index triangle, next, last;
  };

  void add_edges(Index v, std::vector<Spoke>& spokes, CellTracer& tracer) const {
    spokes.clear();
    const bool on_hull =
        rings_.visit(v, [&](Index t, Index next, Index last) { spokes.push_back({t, next, last}); });
    const Point& site = at(v);
    const auto stop = [&](const Spoke& spoke) -> const Stop& {
      return stops_[static_cast<std::size_t>(spoke.triangle)];
    };
    if (on_hull) {  // the rays are at right angles to the hull's sides, outwards
      const Point& next = at(spokes.front().next);
      const Stop& to = stop(spokes.front());
      tracer.add_edge({Frame::far_beyond(to.beyond, next.y - site.y, site.x - next.x), {}}, to, next);
    }
    for (std::size_t k = 0; k + 1 < spokes.size(); ++k) {
      tracer.add_edge(stop(spokes[k]), stop(spokes[k + 1]), at(spokes[k].last));
    }
    const Point& last = at(spokes.back().last);
    const Stop& from = stop(spokes.back());
    if (on_hull) {
      tracer.add_edge(from, {Frame::far_beyond(from.beyond, site.y - last.y, last.x - site.x), {}}, last);
    } else {
      tracer.add_edge(from, stop(spokes.front()), last);
    }
  }

  // The edges at the i-th of the collinear sites.
  void add_lines(std::size_t i, CellTracer& tracer) const {
    if (i > 0) tracer.add_line(at(mesh_.hull[i - 1]));
    if (i + 1 < mesh_.hull.size()) tracer.add_line(at(mesh_.hull[i + 1]));
  }

  // The frame lies in one cell: that of the site nearest to any corner.
  void give_frame_to_nearest(std::span<const Index> order) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < order.size(); ++i) {
      if (frame_.is_nearer(0, at(order[i]), at(order[best]))) best = i;
    }
    std::vector<Point>& vertices = pieces_[best / sites_a_piece];
    for (int k = 0; k < sides; ++k) vertices.push_back(frame_.corner(k));
    starts_[static_cast<std::size_t>(order[best]) + 1] = sides;
  }

  // Rings in the order of the points.
  VoronoiCells gather(std::span<const Index> order) {
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    VoronoiCells cells{base::LargeArray<Point>(static_cast<std::size_t>(starts_.back())), {}};
    const auto copy = [&](std::size_t piece, std::size_t begin, std::size_t end) {
      const std::vector<Point> vertices = std::move(pieces_[piece]);
      auto from = vertices.begin();
      for (std::size_t i = begin; i < end; ++i) {
        const auto v = static_cast<std::size_t>(order[i]);
        const std::int64_t size = starts_[v + 1] - starts_[v];
        std::copy(from, from + size, cells.vertices.data() + starts_[v]);
        from += size;
      }
    };
    for_pieces(order.size(), sites_a_piece, threads_, monitor_, copy);
    cells.starts = std::move(starts_);
    return cells;
  }

  const TriangulationArrays& mesh_;
  const delaunay::VertexTriangles rings_;
  const Frame frame_;
  const unsigned threads_;
  const Monitor& monitor_;
  base::LargeArray<Stop> stops_;            // [triangles] their circumcenters
  std::vector<std::vector<Point>> pieces_;  // vertices of their cells, in the order of the sites
  std::vector<std::int64_t> starts_;        // [n + 1] first the sizes of the rings, each one place later
  std::atomic<bool> any_{false};            // whether any cell's boundary meets the frame
};

}  // namespace

VoronoiCells voronoi_cells(const TriangulationArrays& mesh, const Box& frame, unsigned threads,
                           const Monitor& monitor) {
  return CellMaker(mesh, frame, threads, monitor).run();
}

}  // namespace vorotool::core::cells
