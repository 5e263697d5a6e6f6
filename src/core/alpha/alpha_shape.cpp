#include "core/alpha/alpha_shape.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/disjoint_sets.hpp"
#include "core/base/parallel.hpp"
#include "core/kernel/predicates.hpp"

namespace vorotool::core::alpha {

using base::Monitor;
using kernel::orient2d;
using kernel::Point;

namespace {

constexpr std::size_t edges_a_piece = std::size_t{1} << 16;  // some tenths of a millisecond of work

// Boundary edges by the region on their left and the vertex that they leave.
class RingTracer {
 public:
  RingTracer(std::span<const Point> points, std::span<const std::int32_t> a, std::span<const std::int32_t> b,
             std::span<const std::int32_t> region)
      : points_(points), a_(a), b_(b), region_(region), leaving_(a.size()), used_(a.size()) {
    std::iota(leaving_.begin(), leaving_.end(), std::size_t{0});
    std::sort(leaving_.begin(), leaving_.end(), [this](std::size_t i, std::size_t j) {
      if (region_[i] != region_[j]) return region_[i] < region_[j];
      return a_[i] != a_[j] ? a_[i] < a_[j] : i < j;
    });
  }

  Rings run(const Monitor& monitor) {
    Rings rings;
    std::size_t done = 0;
    for (std::size_t first = 0; first < a_.size(); ++first) {
      if (used_[first]) continue;
      rings.start.push_back(static_cast<std::int32_t>(rings.vertex.size()));
      for (std::size_t edge = first; !used_[edge]; edge = next(edge)) {
        base::report_item(monitor, done++, a_.size());
        used_[edge] = true;
        rings.vertex.push_back(a_[edge]);
      }
      rings.region.push_back(region_[first]);
      const auto begin = static_cast<std::size_t>(rings.start.back());
      rings.is_hole.push_back(is_clockwise(std::span(rings.vertex).subspan(begin)));
    }
    rings.start.push_back(static_cast<std::int32_t>(rings.vertex.size()));
    return rings;
  }

 private:
  const Point& at(std::int32_t v) const { return points_[static_cast<std::size_t>(v)]; }

  // The edge of the same region that comes first, counter-clockwise, after the way back along this one.
  std::size_t next(std::size_t edge) const {
    const auto key = std::pair(region_[edge], b_[edge]);
    const auto less = [this](std::size_t i, const std::pair<std::int32_t, std::int32_t>& wanted) {
      return std::pair(region_[i], a_[i]) < wanted;
    };
    auto place = std::lower_bound(leaving_.begin(), leaving_.end(), key, less);
    if (place == leaving_.end() || std::pair(region_[*place], a_[*place]) != key) {
      throw std::invalid_argument("boundary edge " + std::to_string(edge) +
                                  " is not followed by another one");
    }
    std::size_t best = *place;
    for (++place; place != leaving_.end() && std::pair(region_[*place], a_[*place]) == key; ++place) {
      if (comes_earlier(at(b_[edge]), at(a_[edge]), at(b_[*place]), at(b_[best]))) best = *place;
    }
    return best;
  }

  // Whether the ray from the center to p comes before that to q, turning counter-clockwise from the one to
  // the start. No two of the three are the same.
  static bool comes_earlier(const Point& center, const Point& start, const Point& p, const Point& q) {
    const bool p_in_first_half = is_in_first_half(center, start, p),
               q_in_first_half = is_in_first_half(center, start, q);
    if (p_in_first_half != q_in_first_half) return p_in_first_half;
    return orient2d(center, p, q) > 0;
  }

  // Turned by less than 180 degrees.
  static bool is_in_first_half(const Point& center, const Point& start, const Point& p) {
    return orient2d(center, start, p) > 0;
  }

  // By the corner at the lexicographically smallest vertex: a ring is simple.
  bool is_clockwise(std::span<const std::int32_t> ring) const {
    const auto before = [this](std::int32_t v, std::int32_t w) {
      return at(v).x != at(w).x ? at(v).x < at(w).x : at(v).y < at(w).y;
    };
    const auto k =
        static_cast<std::size_t>(std::min_element(ring.begin(), ring.end(), before) - ring.begin());
    const std::size_t n = ring.size();
    return orient2d(at(ring[(k + n - 1) % n]), at(ring[k]), at(ring[(k + 1) % n])) < 0;
  }

  std::span<const Point> points_;
  std::span<const std::int32_t> a_, b_, region_;
  std::vector<std::size_t> leaving_;  // edges by region and first vertex
  std::vector<bool> used_;
};

}  // namespace

// Each piece writes where it would if all edges before it were in the shape, every candidate, and the next
// one over it unless it is: faster than a branch. Then the pieces are moved together.
ShapeEdges shape_edges(const EdgeRanks& ranks, std::int32_t reached, std::int32_t entered, unsigned threads,
                       const Monitor& monitor) {
  const std::size_t size = ranks.min.size();
  ShapeEdges out{base::LargeArray<std::int32_t>(size), base::LargeArray<std::uint8_t>(size), 0};
  std::vector<std::size_t> counts(base::piece_count(size, edges_a_piece));
  const auto scan = [&](std::size_t piece, std::size_t begin, std::size_t end) {
    std::size_t next = begin;
    for (std::size_t e = begin; e < end; ++e) {
      out.edge[next] = static_cast<std::int32_t>(e);
      out.kind[next] =
          static_cast<std::uint8_t>(ranks.mid[e] < reached ? EdgeClass::boundary : EdgeClass::singular);
      next += std::size_t{ranks.min[e] < entered} & std::size_t{ranks.max[e] >= reached};
    }
    counts[piece] = next - begin;
  };
  base::for_pieces(size, edges_a_piece, threads, monitor, scan);
  for (std::size_t piece = 0; piece < counts.size(); ++piece) {
    const std::size_t begin = piece * edges_a_piece, end = begin + counts[piece];
    std::copy(out.edge.data() + begin, out.edge.data() + end, out.edge.data() + out.count);
    std::copy(out.kind.data() + begin, out.kind.data() + end, out.kind.data() + out.count);
    out.count += counts[piece];
  }
  return out;
}

std::vector<std::int32_t> connected_triangles(std::span<const std::uint8_t> is_inside,
                                              std::span<const std::int32_t> sides, const Monitor& monitor) {
  const std::size_t count = is_inside.size();
  base::DisjointSets sets(count + 1);  // 0 is the unbounded face, t + 1 a triangle
  for (std::size_t k = 0; k < sides.size(); k += 2) {
    base::report_item(monitor, k, sides.size());
    const std::int32_t t = sides[k], u = sides[k + 1];
    const bool in_t = t >= 0 && is_inside[static_cast<std::size_t>(t)] != 0;
    const bool in_u = u >= 0 && is_inside[static_cast<std::size_t>(u)] != 0;
    if (in_t == in_u) sets.join(static_cast<std::uint32_t>(t + 1), static_cast<std::uint32_t>(u + 1));
  }
  std::vector<std::int32_t> number(count + 1, -1);
  std::int32_t next[2] = {0, 0};
  for (std::size_t t = 0; t < count; ++t) {
    const std::uint32_t leader = sets.find(static_cast<std::uint32_t>(t + 1));
    if (leader == t + 1) number[t + 1] = next[is_inside[t] != 0 ? 1 : 0]++;
    number[t + 1] = number[leader];
  }
  number.erase(number.begin());
  return number;
}

Rings trace_rings(std::span<const Point> points, std::span<const std::int32_t> a,
                  std::span<const std::int32_t> b, std::span<const std::int32_t> region,
                  const Monitor& monitor) {
  return RingTracer(points, a, b, region).run(monitor);
}

}  // namespace vorotool::core::alpha
