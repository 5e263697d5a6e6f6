#include "core/alpha/alpha_complex.hpp"

#include <algorithm>
#include <numeric>

#include "core/alpha/critical_radius.hpp"
#include "core/alpha/radius_ranks.hpp"
#include "core/base/parallel.hpp"
#include "core/kernel/predicates.hpp"
#include "core/numbers/special_values.hpp"

namespace vorotool::core::alpha {

using base::for_items;
using base::for_pieces;
using base::LargeArray;
using base::Monitor;
using kernel::Point;
using numbers::infinity;

namespace {

constexpr std::size_t simplices_a_piece = std::size_t{1} << 13;  // about a millisecond of work
constexpr std::size_t ahead = 16;                                // triangles or edges

// Calls visit(side number) for the sides of triangles first ... end - 1 at which an edge is written.
template <class Visit>
void visit_edges(std::span<const std::int32_t> neighbors, std::size_t first, std::size_t end, Visit visit) {
  for (std::size_t t = first; t < end; ++t) {
    for (std::size_t k = 3 * t; k < 3 * t + 3; ++k) {
      if (neighbors[k] < 0 || neighbors[k] > static_cast<std::int32_t>(t)) visit(k);
    }
  }
}

class AlphaBuilder {
 public:
  AlphaBuilder(const AlphaInput& input, AlphaRule rule, unsigned threads, const Monitor& monitor)
      : in_(input),
        rule_(rule),
        threads_(threads),
        monitor_(monitor),
        triangles_(input.triangles.size() / 3),
        edges_(input.edges.size() / 2),
        value_(triangles_ + edges_),
        obtuse_(triangles_) {}

  AlphaArrays run() {
    measure_triangles();
    measure_edges();
    const auto compare = [this](std::uint32_t q) {
      return [this, q](std::uint32_t p) { return compare_radii(support_of(p), support_of(q)); };
    };
    const std::span values(value_.data(), value_.size());
    return write(rank_radii(values, compare, threads_, monitor_));
  }

 private:
  static constexpr double left_out = -1;

  const Point& at(std::int32_t v) const { return in_.points[static_cast<std::size_t>(v)]; }
  const Point& corner(std::size_t t, std::size_t k) const { return at(in_.triangles[3 * t + k]); }
  std::size_t side(std::size_t edge, std::size_t k) const {
    return static_cast<std::size_t>(in_.sides[2 * edge + k]);
  }
  bool has_side(std::size_t edge, std::size_t k) const { return in_.sides[2 * edge + k] >= 0; }

  Support support_of(std::uint32_t item) const {
    if (item < triangles_) return {corner(item, 0), corner(item, 1), corner(item, 2), true};
    const std::size_t edge = item - triangles_;
    const Point& a = at(in_.edges[2 * edge]);
    return {a, at(in_.edges[2 * edge + 1]), a, false};
  }

  // Points may be anywhere in memory: they are called for before they are needed.
  void call_for(std::span<const std::int32_t> corners, std::size_t first, std::size_t count) const {
    for (std::size_t i = first; i < std::min(first + count, corners.size()); ++i)
      __builtin_prefetch(&at(corners[i]));
  }

  void measure_triangles() {
    for_items(triangles_, simplices_a_piece, threads_, monitor_, [&](std::size_t t) {
      call_for(in_.triangles, 3 * (t + ahead), 3);
      const Point &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
      const TriangleMeasure found = measure_triangle(a, b, c);
      const bool is_flat = found.radius == infinity && kernel::orient2d(a, b, c) == 0;
      value_[t] = is_flat ? left_out : found.radius;
      obtuse_[t] = static_cast<std::uint8_t>(found.obtuse);
    });
  }

  // Whether the corner of a triangle opposite to an edge is strictly inside the edge's diametral disc.
  bool is_cut_by(std::size_t edge, std::size_t t) const {
    if (obtuse_[t] > 2) return false;
    const std::int32_t apex = in_.triangles[3 * t + obtuse_[t]];
    return apex != in_.edges[2 * edge] && apex != in_.edges[2 * edge + 1];
  }

  bool starts_at_half(std::size_t edge) const {
    const bool both = has_side(edge, 0) && has_side(edge, 1);
    if (both && rule_ == AlphaRule::printed) return true;
    return !(has_side(edge, 0) && is_cut_by(edge, side(edge, 0))) &&
           !(has_side(edge, 1) && is_cut_by(edge, side(edge, 1)));
  }

  void measure_edges() {
    for_items(edges_, simplices_a_piece, threads_, monitor_, [&](std::size_t e) {
      call_for(in_.edges, 2 * (e + ahead), 2);
      const std::size_t i = triangles_ + e;
      value_[i] = starts_at_half(e) ? critical_radius(support_of(static_cast<std::uint32_t>(i))) : left_out;
    });
  }

  // A rank, and the radius that has it.
  struct Critical {
    std::int32_t rank;
    double radius;
  };

  Critical circumradius(const RadiusRanks& spectrum, std::size_t edge, std::size_t k) const {
    if (!has_side(edge, k)) return {static_cast<std::int32_t>(spectrum.value.size()), infinity};
    const std::size_t t = side(edge, k);
    return {spectrum.rank[t], value_[t] < 0 ? infinity : value_[t]};
  }

  AlphaArrays write(RadiusRanks&& spectrum) const {
    AlphaArrays out(triangles_, edges_);
    for_items(edges_, simplices_a_piece, threads_, monitor_, [&](std::size_t e) {
      Critical mid = circumradius(spectrum, e, 0), max = circumradius(spectrum, e, 1);
      if (max.rank < mid.rank) std::swap(mid, max);
      const double half = value_[triangles_ + e];
      const Critical min = half < 0 ? mid : Critical{spectrum.rank[triangles_ + e], half};
      out.r_min[e] = min.radius;
      out.r_mid[e] = mid.radius;
      out.r_max[e] = max.radius;
      out.rank_min[e] = min.rank;
      out.rank_mid[e] = mid.rank;
      out.rank_max[e] = max.rank;
    });
    for_items(triangles_, simplices_a_piece, threads_, monitor_,
              [&](std::size_t t) { out.triangle_rank[t] = spectrum.rank[t]; });
    out.spectrum = std::move(spectrum.value);
    out.witness = std::move(spectrum.witness);
    return out;
  }

  const AlphaInput& in_;
  AlphaRule rule_;
  unsigned threads_;
  const Monitor& monitor_;
  std::size_t triangles_, edges_;
  LargeArray<double> value_;         // [triangles + edges] radii at which the shape changes, or left out
  LargeArray<std::uint8_t> obtuse_;  // [triangles] the corner with an obtuse angle; 3 if there is none
};

}  // namespace

EdgeArrays edges_of_triangles(std::span<const std::int32_t> triangles,
                              std::span<const std::int32_t> neighbors, unsigned threads,
                              const Monitor& monitor) {
  const std::size_t count = triangles.size() / 3;
  std::vector<std::size_t> start(base::piece_count(count, simplices_a_piece) + 1);
  for_pieces(count, simplices_a_piece, threads, monitor,
             [&](std::size_t piece, std::size_t first, std::size_t end) {
               visit_edges(neighbors, first, end, [&](std::size_t) { ++start[piece + 1]; });
             });
  std::partial_sum(start.begin(), start.end(), start.begin());
  EdgeArrays out{LargeArray<std::int32_t>(2 * start.back()), LargeArray<std::int32_t>(2 * start.back())};
  for_pieces(count, simplices_a_piece, threads, monitor,
             [&](std::size_t piece, std::size_t first, std::size_t end) {
               std::size_t next = 2 * start[piece];
               visit_edges(neighbors, first, end, [&](std::size_t k) {
                 const std::size_t t = k / 3;
                 const std::int32_t a = triangles[3 * t + (k + 1) % 3], b = triangles[3 * t + (k + 2) % 3];
                 out.ends[next] = std::min(a, b);
                 out.ends[next + 1] = std::max(a, b);
                 out.sides[next] = static_cast<std::int32_t>(t);
                 out.sides[next + 1] = neighbors[k];
                 next += 2;
               });
             });
  return out;
}

AlphaArrays alpha_complex(const AlphaInput& input, AlphaRule rule, unsigned threads, const Monitor& monitor) {
  return AlphaBuilder(input, rule, threads, monitor).run();
}

}  // namespace vorotool::core::alpha
