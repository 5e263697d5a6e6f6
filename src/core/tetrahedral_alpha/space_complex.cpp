#include "core/tetrahedral_alpha/space_complex.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
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

// Of the two corners beside an edge (first, second) the one from which the tetrahedron leads to the other, turning
// around the edge.
constexpr std::size_t begins_at(std::size_t first, std::size_t second) {
  constexpr std::array<std::array<std::size_t, 4>, 4> corner{
      {{4, 2, 3, 1}, {3, 4, 0, 2}, {1, 3, 4, 0}, {2, 0, 1, 4}}};
  return corner[first][second];
}

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
        stars_(cells, points.size(), threads, monitor),
        scaled_(points, stars_.order()),
        cut_(width == 4 ? count_ : 0) {}

  SpaceArrays run() {
    if constexpr (width == 4) find_facets();
    const LargeArray<std::uint8_t> edge_is_cut =
        stars_.find_edges([&](const Visit& visit) { return is_edge_cut(visit); });
    value_ = LargeArray<double>(count_ + facet_.size() + stars_.size());
    measure_cells();
    measure_facets();
    measure_edges(edge_is_cut);
    const auto compare = [&](std::uint32_t p, std::uint32_t q) {
      return compare_radii(simplex_of(p), simplex_of(q), scaled_.are_integers);
    };
    const std::span<const double> values(value_.data(), value_.size());
    return write(alpha::rank_radii(values, compare, threads_, monitor_, open_bits));
  }

 private:
  const Point3& point(std::int32_t v) const { return scaled_.points[at(v)]; }

  Simplex simplex_of(std::size_t item) const {
    Simplex s;
    const auto put = [&](std::int32_t v) { s.corner[s.size++] = &point(v); };
    if (item < count_) {
      for (const std::int32_t v : stars_.cell(item)) put(v);
    } else if (item < count_ + facet_.size()) {
      const std::size_t facet = at(facet_[item - count_]);
      if constexpr (width == 4) {
        for (const std::size_t k : facets[facet % 4]) put(stars_.cell(facet / 4)[k]);
      }
    } else {
      for (const std::int32_t v : stars_.ends(item - count_ - facet_.size())) put(v);
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

  // The same facet of the tetrahedron across, or -1.
  std::int32_t across(std::size_t facet) const {
    const std::int32_t u = neighbors_[facet / 4][facet % 4];
    if (u < 0) return -1;
    const Row& back = neighbors_[at(u)];
    const auto k = std::find(back.begin(), back.end(), static_cast<std::int32_t>(facet / 4)) - back.begin();
    return 4 * u + static_cast<std::int32_t>(k & 3);
  }

  void measure_cells() {
    for_items(count_, simplices_a_piece, threads_, monitor_, [&](std::size_t t) {
      if constexpr (width == 4) {
        const TetrahedronMeasure found = measure_tetrahedron(simplex_of(t), scaled_.are_integers);
        value_[t] = found.radius;
        cut_[t] = found.cut;
      } else {
        value_[t] = ranked_radius(simplex_of(t), scaled_.are_integers);
      }
    });
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

  using Visit = typename EdgeStars<width>::Visit;

  // Each corner opposite to an edge is that of one or two cells around it: of tetrahedra it is looked at where it is the
  // first of two around the edge, or where no other follows.
  bool is_edge_cut(const Visit& visit) const {
    const Cell& cell = stars_.cell(visit.cell);
    const auto holds = [&](std::size_t corner) {
      return is_inside_diametral_sphere(point(cell[visit.first]), point(cell[visit.second]),
                                        point(cell[corner]), scaled_.are_integers);
    };
    if constexpr (width == 2) {
      return false;
    } else if constexpr (width == 3) {
      return holds(3 - visit.first - visit.second);
    } else {
      const std::size_t begin = begins_at(visit.first, visit.second);
      if (holds(begin)) return true;
      return neighbors_[visit.cell][begin] < 0 && holds(6 - visit.first - visit.second - begin);
    }
  }

  void measure_edges(const LargeArray<std::uint8_t>& is_cut) {
    for_items(stars_.size(), simplices_a_piece, threads_, monitor_, [&](std::size_t e) {
      const std::size_t item = count_ + facet_.size() + e;
      value_[item] = is_cut[e] != 0 ? left_out : ranked_radius(simplex_of(item), scaled_.are_integers);
    });
  }

  SpaceArrays write(alpha::RadiusRanks&& ranks) {
    SpaceArrays out;
    const auto last = static_cast<std::int32_t>(ranks.value.size());
    value_ = {};
    LargeArray<std::int32_t> facet_min(4 * count_);  // of each facet
    out.triangle_min = LargeArray<std::int32_t>(facet_.size());
    for_items(facet_.size(), simplices_a_piece, threads_, monitor_, [&](std::size_t m) {
      const std::int32_t own = ranks.rank[count_ + m], facet = facet_[m], other = across(at(facet));
      std::int32_t least = std::min(own, ranks.rank[at(facet) / 4]);
      if (other >= 0) least = std::min(least, ranks.rank[at(other) / 4]);
      out.triangle_min[m] = facet_min[at(facet)] = least;
      if (other >= 0) facet_min[at(other)] = least;
    });
    out.edge_min = LargeArray<std::int32_t>(stars_.size());
    out.edge_mid = LargeArray<std::int32_t>(stars_.size());
    out.edge_max = LargeArray<std::int32_t>(stars_.size());
    for_items(stars_.size(), simplices_a_piece, threads_, monitor_, [&](std::size_t e) {
      out.edge_min[e] = ranks.rank[count_ + facet_.size() + e];
      out.edge_mid[e] = last;
      out.edge_max[e] = width == 4 ? 0 : last;
    });
    stars_.for_visits([&](std::size_t e, const Visit& visit) {
      if constexpr (width == 2) return;
      const std::int32_t rank = ranks.rank[visit.cell];
      const auto lower = [](std::int32_t& value, std::int32_t by) { value = std::min(value, by); };
      if constexpr (width == 4) {
        lower(out.edge_mid[e], rank);
        out.edge_max[e] = std::max(out.edge_max[e], rank);
        const std::size_t k = begins_at(visit.first, visit.second), l = 6 - visit.first - visit.second - k;
        for (const std::size_t opposite : {k, l}) {
          lower(out.edge_min[e], facet_min[4 * visit.cell + opposite]);
          if (neighbors_[visit.cell][opposite] < 0) out.edge_max[e] = last;
        }
      } else {
        lower(out.edge_min[e], rank);
      }
    });
    (width == 4 ? out.tetrahedron_rank : out.triangle_min) = LargeArray<std::int32_t>(count_);
    std::copy(ranks.rank.data(), ranks.rank.data() + count_,
              (width == 4 ? out.tetrahedron_rank : out.triangle_min).data());
    out.facet = std::move(facet_);
    out.edges = LargeArray<Ends>(stars_.size());
    for_items(stars_.size(), simplices_a_piece, threads_, monitor_, [&](std::size_t e) {
      const auto [a, b] = stars_.ends(e);
      const std::int32_t p = stars_.order()[at(a)], q = stars_.order()[at(b)];
      out.edges[e] = {std::min(p, q), std::max(p, q)};
    });
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

  std::size_t count_;  // of cells that are ranked
  std::span<const Row> neighbors_;
  unsigned threads_;
  const Monitor& monitor_;
  EdgeStars<width> stars_;
  ScaledPoints scaled_;           // by the new numbers
  LargeArray<std::uint8_t> cut_;  // [tetrahedra] TetrahedronMeasure::cut
  LargeArray<std::int32_t> facet_;
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
