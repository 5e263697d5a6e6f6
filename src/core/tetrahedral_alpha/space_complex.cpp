#include "core/tetrahedral_alpha/space_complex.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/alpha/radius_ranks.hpp"
#include "core/base/parallel.hpp"
#include "core/tetrahedral_alpha/edge_stars.hpp"
#include "core/tetrahedral_alpha/simplex_radius.hpp"

namespace vorotool::core::tetrahedral_alpha {

using base::for_items;
using base::for_pieces;
using base::Monitor;
using tetrahedra::Point3;

namespace {

constexpr std::size_t simplices_a_piece = std::size_t{1} << 12;  // about a millisecond of work
constexpr double left_out = -1;

// The corners of the facet opposite to each corner of a tetrahedron.
constexpr std::array<std::array<std::size_t, 3>, 4> facets{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

// Cells are tetrahedra (width 4), or triangles of points in a plane (3), or edges of points on a line (2), which are not
// ranked as cells, but as edges alone.
template <std::size_t width>
class Builder {
 public:
  using Cell = std::array<std::int32_t, width>;

  Builder(std::span<const Point3> points, std::span<const Cell> cells, std::span<const Row> neighbors,
          unsigned threads, const Monitor& monitor)
      : count_(width == 2 ? 0 : cells.size()),
        neighbors_(neighbors),
        threads_(threads),
        monitor_(monitor),
        cells_(cells.size()),
        order_(number_vertices(cells, points.size())),
        stars_(stars_of_cells()),
        scaled_(points, order_),
        cut_(width == 4 ? count_ : 0),
        obtuse_(cut_.size()) {}

  SpaceArrays run() {
    LargeArray<double> radius = measure_cells();
    if constexpr (width == 4) find_facets();
    edges_ =
        stars_.find(order_.size(), [this](auto... facet) { return is_cut_by(facet...); }, threads_, monitor_);
    value_ = LargeArray<double>(count_ + facet_.size() + edges_.size());
    std::copy(radius.data(), radius.data() + count_, value_.data());
    radius = {};
    measure_facets();
    measure_edges();
    const auto compare = [&](std::uint32_t p, std::uint32_t q) {
      return compare_radii(simplex_of(p), simplex_of(q), scaled_.are_integers);
    };
    alpha::RefineItem refine;  // integers, where ties are many, are compared as quickly
    if (!scaled_.are_integers) refine = [&](std::uint32_t item) { return refine_radius(simplex_of(item)); };
    alpha::RadiusRanks ranks =
        alpha::rank_radii(std::move(value_), compare, threads_, monitor_, open_bits, refine);
    cells_ = {}, scaled_.points = {};
    return write(std::move(ranks));
  }

 private:
  using Stars = std::conditional_t<width == 4, TetrahedronStars, PlanarStars<width>>;

  Stars stars_of_cells() const {
    const std::span<const Cell> all(cells_.data(), cells_.size());
    if constexpr (width == 4) {
      return {all, neighbors_, threads_, monitor_};
    } else {
      return Stars(all);
    }
  }

  // Vertices get new numbers, in the order in which they first appear in the cells, so that those near each other come
  // together. Gives the old ones.
  std::vector<std::int32_t> number_vertices(std::span<const Cell> cells, std::size_t points) {
    std::vector<std::int32_t> place(points, base::no_index), order;
    for (std::size_t t = 0; t < cells.size(); ++t) {
      for (std::size_t k = 0; k < width; ++k) {
        std::int32_t& number = place[at(cells[t][k])];
        if (number == base::no_index) {
          number = static_cast<std::int32_t>(order.size());
          order.push_back(cells[t][k]);
        }
        cells_[t][k] = number;
      }
    }
    return order;
  }

  const Point3& point(std::int32_t v) const { return scaled_.points[at(v)]; }

  Simplex simplex_of(std::size_t item) const {
    Simplex s;
    const auto put = [&](std::int32_t v) { s.corner[s.size++] = &point(v); };
    if (item < count_) {
      for (const std::int32_t v : cells_[item]) put(v);
    } else if (item < count_ + facet_.size()) {
      const std::size_t facet = at(facet_[item - count_]);
      if constexpr (width == 4) {
        for (const std::size_t k : facets[facet % 4]) put(cells_[facet / 4][k]);
      }
    } else {
      for (const std::int32_t v : edges_[item - count_ - facet_.size()].ends) put(v);
    }
    return s;
  }

  // Calls visit(4 t + k) for the facets at which a triangle is written: of a tetrahedron whose neighbor came before.
  template <class Visit>
  void visit_facets(std::size_t begin, std::size_t end, const Visit& visit) const {
    for (std::size_t t = begin; t < end; ++t) {
      for (std::size_t k = 0; k < 4; ++k) {
        if (neighbors_[t][k] < static_cast<std::int32_t>(t)) visit(4 * t + k);
      }
    }
  }

  void find_facets() {
    std::vector<std::size_t> start(base::piece_count(count_, simplices_a_piece) + 1);
    for_pieces(count_, simplices_a_piece, threads_, monitor_,
               [&](std::size_t piece, std::size_t begin, std::size_t end) {
                 visit_facets(begin, end, [&](std::size_t) { ++start[piece + 1]; });
               });
    std::partial_sum(start.begin(), start.end(), start.begin());
    facet_ = LargeArray<std::int32_t>(start.back());
    for_pieces(count_, simplices_a_piece, threads_, monitor_,
               [&](std::size_t piece, std::size_t begin, std::size_t end) {
                 std::size_t next = start[piece];
                 visit_facets(begin, end,
                              [&](std::size_t f) { facet_[next++] = static_cast<std::int32_t>(f); });
               });
  }

  std::int32_t across(std::size_t facet) const {
    if constexpr (width == 4) return stars_.across(facet);
    return -1;
  }

  LargeArray<double> measure_cells() {
    LargeArray<double> radius(count_);
    for_items(count_, simplices_a_piece, threads_, monitor_, [&](std::size_t t) {
      if constexpr (width == 4) {
        const TetrahedronMeasure found = measure_tetrahedron(simplex_of(t), scaled_.are_integers);
        radius[t] = found.radius;
        cut_[t] = found.cut;
        obtuse_[t] = found.obtuse;
      } else {
        radius[t] = ranked_radius(simplex_of(t), scaled_.are_integers);
      }
    });
    return radius;
  }

  bool is_cut(std::int32_t facet) const {
    return facet >= 0 && (cut_[at(facet) / 4] >> (facet % 4) & 1) != 0;
  }

  void measure_facets() {
    for_items(facet_.size(), simplices_a_piece, threads_, monitor_, [&](std::size_t m) {
      const std::size_t item = count_ + m;
      const bool is_gabriel = !is_cut(facet_[m]) && !is_cut(across(at(facet_[m])));
      value_[item] = is_gabriel ? ranked_radius(simplex_of(item), scaled_.are_integers) : left_out;
    });
  }

  // Whether the corner of a triangle opposite to an edge is strictly inside the sphere on it as diameter.
  bool is_cut_by(const Edge&, std::size_t t, std::size_t out, std::size_t apex) const {
    return (obtuse_[t] >> 2 * out & 3U) == apex;
  }
  bool is_cut_by(const Edge& edge, std::int32_t apex) const {
    const auto [a, b] = edge.ends;
    return is_inside_diametral_sphere(point(a), point(b), point(apex), scaled_.are_integers);
  }

  void measure_edges() {
    for_items(edges_.size(), simplices_a_piece, threads_, monitor_, [&](std::size_t e) {
      const std::size_t item = count_ + facet_.size() + e;
      value_[item] = edges_[e].is_cut != 0 ? left_out : ranked_radius(simplex_of(item), scaled_.are_integers);
    });
  }

  SpaceArrays write(alpha::RadiusRanks&& ranks) {
    SpaceArrays out;
    const auto last = static_cast<std::int32_t>(ranks.value.size());
    LargeArray<std::int32_t> facet_min(4 * count_);  // of each facet
    out.triangle_min = LargeArray<std::int32_t>(facet_.size());
    for_items(facet_.size(), simplices_a_piece, threads_, monitor_, [&](std::size_t m) {
      const std::int32_t own = ranks.rank[count_ + m], facet = facet_[m], other = across(at(facet));
      std::int32_t least = std::min(own, ranks.rank[at(facet) / 4]);
      if (other >= 0) least = std::min(least, ranks.rank[at(other) / 4]);
      out.triangle_min[m] = facet_min[at(facet)] = least;
      if (other >= 0) facet_min[at(other)] = least;
    });
    write_edges(out, ranks.rank, facet_min, last);
    (width == 4 ? out.tetrahedron_rank : out.triangle_min) = LargeArray<std::int32_t>(count_);
    std::copy(ranks.rank.data(), ranks.rank.data() + count_,
              (width == 4 ? out.tetrahedron_rank : out.triangle_min).data());
    out.facet = std::move(facet_);
    const double scale = std::ldexp(1.0, scaled_.exponent);
    double so_far = 0;
    for (std::size_t i = 0; i < ranks.value.size(); ++i) {
      so_far = std::max(so_far, ranks.value[i]);
      ranks.value[i] = so_far * scale;
    }
    out.spectrum = std::move(ranks.value);
    out.witness = std::move(ranks.witness);
    return out;
  }

  void write_edges(SpaceArrays& out, const LargeArray<std::int32_t>& rank,
                   const LargeArray<std::int32_t>& facet_min, std::int32_t last) const {
    const std::size_t count = edges_.size(), first = count_ + facet_.size();
    out.edges = LargeArray<Ends>(count);
    out.edge_min = LargeArray<std::int32_t>(count);
    out.edge_mid = LargeArray<std::int32_t>(count);
    out.edge_max = LargeArray<std::int32_t>(count);
    for_items(count, simplices_a_piece, threads_, monitor_, [&](std::size_t e) {
      std::int32_t min = rank[first + e], mid = last, max = width == 4 ? 0 : last;
      if constexpr (width == 4) {
        stars_.visit(edges_[e], [&](std::size_t t, std::size_t opposite, std::size_t) {
          min = std::min(min, facet_min[4 * t + opposite]);
          mid = std::min(mid, rank[t]);
          max = std::max(max, neighbors_[t][opposite] < 0 ? last : rank[t]);
          return true;
        });
      } else if constexpr (width == 3) {
        stars_.visit(edges_[e], [&](std::size_t t) { min = std::min(min, rank[t]); });
      }
      out.edge_min[e] = min, out.edge_mid[e] = mid, out.edge_max[e] = max;
      const auto [a, b] = edges_[e].ends;
      const std::int32_t p = order_[at(a)], q = order_[at(b)];
      out.edges[e] = {std::min(p, q), std::max(p, q)};
    });
  }

  std::size_t count_;  // of cells that are ranked
  std::span<const Row> neighbors_;
  unsigned threads_;
  const Monitor& monitor_;
  LargeArray<Cell> cells_;           // by the new numbers
  std::vector<std::int32_t> order_;  // the old numbers
  Stars stars_;
  ScaledPoints scaled_;
  LargeArray<std::uint8_t> cut_, obtuse_;  // [tetrahedra] TetrahedronMeasure
  LargeArray<std::int32_t> facet_;
  LargeArray<Edge> edges_;
  LargeArray<double> value_;  // [cells + facets + edges] radii at which shapes change, or left out
};

}  // namespace

SpaceArrays space_complex(const SpaceInput& input, unsigned threads, const Monitor& monitor) {
  if (!input.tetrahedra.empty())
    return Builder<4>(input.points, input.tetrahedra, input.neighbors, threads, monitor).run();
  if (!input.triangles.empty()) return Builder<3>(input.points, input.triangles, {}, threads, monitor).run();
  return Builder<2>(input.points, input.edges, {}, threads, monitor).run();
}

}  // namespace vorotool::core::tetrahedral_alpha
