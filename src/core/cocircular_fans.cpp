#include "core/cocircular_fans.hpp"

#include <cstdint>

#include "core/parallel.hpp"

namespace vorotool::core {

namespace {

constexpr std::size_t edges_a_piece = std::size_t{1} << 14;

class FanMaker {
 public:
  FanMaker(HalfEdges& edges, std::span<const Point> points)
      : edges_(edges), points_(points), diagonal_(static_cast<std::size_t>(edges.size()) / 2, 0) {}

  // An edge is a diagonal of a cocircular polygon when the apexes of its two triangles and its ends are
  // cocircular.
  void find_diagonals(const std::vector<bool>& outer, unsigned threads, const Monitor& monitor) {
    const auto find = [&](std::size_t piece) {
      const std::size_t end = std::min(diagonal_.size(), (piece + 1) * edges_a_piece);
      for (std::size_t k = piece * edges_a_piece; k < end; ++k) {
        const auto e = static_cast<HalfEdge>(2 * k);
        if (!edges_.exists(e) || outer[2 * k] || outer[2 * k + 1]) continue;
        const Point& left = at(edges_.target(edges_.next_left(e)));
        const Point& right = at(edges_.target(edges_.next_left(HalfEdges::twin(e))));
        diagonal_[k] = incircle(at(edges_.origin(e)), at(edges_.target(e)), left, right) == 0;
      }
    };
    parallel_for(piece_count(diagonal_.size(), edges_a_piece), threads, find, monitor);
  }

  // A fan's diagonals all leave one vertex; once made, they are looked at no more.
  void make_all() {
    for (std::size_t k = 0; k < diagonal_.size(); ++k) {
      if (diagonal_[k] == open) make_fan(smallest_corner(static_cast<HalfEdge>(2 * k)));
    }
  }

 private:
  enum : std::uint8_t { no, open, done };

  const Point& at(Vertex v) const { return points_[static_cast<std::size_t>(v)]; }
  std::uint8_t& diagonal(HalfEdge e) { return diagonal_[static_cast<std::size_t>(e) / 2]; }

  // The next side of the polygon after the side or diagonal `e`, whose polygon lies on its left.
  HalfEdge next_side(HalfEdge e) {
    HalfEdge side = edges_.next_left(e);
    while (diagonal(side) != no) side = edges_.next_left(HalfEdges::twin(side));
    return side;
  }

  // The side of the polygon around a diagonal that leaves its lexicographically smallest vertex.
  HalfEdge smallest_corner(HalfEdge within) {
    const HalfEdge start = next_side(within);
    HalfEdge best = start;
    for (HalfEdge side = next_side(start); side != start; side = next_side(side)) {
      const Point& p = at(edges_.origin(side));
      const Point& q = at(edges_.origin(best));
      if (p.x < q.x || (p.x == q.x && p.y < q.y)) best = side;
    }
    return best;
  }

  // Turns from the side around its origin; in each triangle on the way the side opposite to the origin is
  // flipped until it is a side of the polygon.
  void make_fan(HalfEdge spoke) {
    for (;;) {
      for (HalfEdge far = edges_.next_left(spoke); diagonal(far) != no; far = edges_.next_left(spoke))
        flip(far);
      spoke = edges_.next_around(spoke);
      if (diagonal(spoke) == no) return;
      diagonal(spoke) = done;
    }
  }

  // Replaces the diagonal of the two triangles at an edge by the other one.
  void flip(HalfEdge e) {
    const HalfEdge twin = HalfEdges::twin(e);
    const HalfEdge a = edges_.previous_around(e);
    const HalfEdge b = edges_.previous_around(twin);
    const std::uint8_t state = diagonal(e);
    edges_.remove(e);
    edges_.make(e, edges_.target(a), edges_.target(b));
    edges_.splice(e, edges_.next_left(a));
    edges_.splice(twin, edges_.next_left(b));
    diagonal(e) = state;
  }

  HalfEdges& edges_;
  std::span<const Point> points_;
  std::vector<std::uint8_t> diagonal_;  // [edges] no, open or done
};

}  // namespace

void make_fans(HalfEdges& edges, const std::vector<bool>& outer, std::span<const Point> points,
               unsigned threads, const Monitor& monitor) {
  FanMaker maker(edges, points);
  maker.find_diagonals(outer, threads, monitor);
  maker.make_all();
}

}  // namespace vorotool::core
