#include "core/tetrahedral_alpha/space_complex.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/alpha/radius_ranks.hpp"
#include "core/base/parallel.hpp"
#include "core/tetrahedral_alpha/edge_stars.hpp"
#include "core/tetrahedral_alpha/facets.hpp"
#include "core/tetrahedral_alpha/radius_bounds.hpp"
#include "core/tetrahedral_alpha/scaled_points.hpp"
#include "core/tetrahedral_alpha/simplex_measures.hpp"
#include "core/tetrahedral_alpha/simplex_radius.hpp"

namespace vorotool::core::tetrahedral_alpha {

using base::for_items;
using base::for_pieces;
using base::Monitor;
using tetrahedra::Point3;

namespace {

constexpr std::size_t simplices_a_piece = std::size_t{1} << 12;  // about a millisecond of work
constexpr std::size_t values_a_piece = std::size_t{1} << 16;     // which are but copied
constexpr double left_out = -1;
constexpr int passes = 12;  // over all simplices of a kind; over all of them, for the ranks

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
        passes_(monitor, passes),
        cells_(cells.size()),
        order_(number_vertices(cells, points.size())),
        stars_(std::span<const Cell>(cells_.data(), cells_.size()), order_.size(), threads, passes_),
        scaled_(points, order_, threads, passes_.same()),
        given_(cells) {}

  SpaceArrays run() {
    LargeArray<std::uint8_t> cut(cells_.size()), cut_sides(cells_.size());
    if constexpr (width == 4) facet_ = facets_->find(threads_, passes_.next());
    value_ = LargeArray<double>(count_ + facet_.size() + expected_edges());
    measure_cells(cut, cut_sides);
    auto [ends, is_cut] =
        stars_.find({cells_.data(), cells_.size()}, [&](std::size_t t) -> unsigned { return cut_sides[t]; });
    cut_sides = {};
    edges_ = std::move(ends);
    if (edges_.size() != expected_edges()) {
      LargeArray<double> radius =
          std::exchange(value_, LargeArray<double>(count_ + facet_.size() + edges_.size()));
      copy(radius.data(), value_.data());
    }
    if constexpr (width == 4) measure_facets(cut);
    cut = {};
    measure<2>(
        count_ + facet_.size(), edges_.size(), [&](std::size_t e) { return edges_[e]; },
        [&](std::size_t e) { return std::size_t{is_cut[e]}; });
    is_cut = {}, cells_ = {};
    const auto compare = [&](std::uint32_t q) {
      return [this, radius = ExactRadius(simplex_of(q), scaled_.are_integers)](std::uint32_t p) {
        return radius.compare(simplex_of(p));
      };
    };
    alpha::RefineItem refine;  // integers, where ties are many, are compared as quickly
    if (!scaled_.are_integers) refine = [&](std::uint32_t item) { return refine_radius(simplex_of(item)); };
    const Monitor monitor = passes_.next();
    alpha::RadiusRanks ranks =
        alpha::rank_radii(std::move(value_), compare, threads_, monitor, bounds::open_bits, refine,
                          std::ldexp(1.0, scaled_.exponent));
    scaled_.points = {};
    return write(std::move(ranks));
  }

 private:
  // The old numbers of the vertices, by new ones in the order in which they first appear in the cells, so that those near
  // each other come together.
  std::vector<std::int32_t> number_vertices(std::span<const Cell> cells, std::size_t points) {
    std::vector<std::int32_t> order;
    const auto number = [&] {
      place_.assign(points, base::no_index);
      for (std::size_t t = 0; t < cells.size(); ++t) {
        for (std::size_t k = 0; k < width; ++k) {
          std::int32_t& place = place_[at(cells[t][k])];
          if (place == base::no_index) {
            place = static_cast<std::int32_t>(order.size());
            order.push_back(cells[t][k]);
          }
          cells_[t][k] = place;
        }
      }
    };
    if constexpr (width == 4) {
      facets_.emplace(cells, neighbors_, threads_, passes_.next(), number);
    } else {
      number();
    }
    return order;
  }

  const Point3& point(std::int32_t v) const { return scaled_.points[at(v)]; }

  std::int32_t corner(std::size_t t, std::size_t k) const {
    return cells_.size() != 0 ? cells_[t][k] : place_[at(given_[t][k])];
  }

  Simplex simplex_of(std::size_t item) const {
    Simplex s;
    const auto put = [&](std::int32_t v) { s.corner[s.size++] = &point(v); };
    if (item < count_) {
      for (std::size_t k = 0; k < width; ++k) put(corner(item, k));
    } else if (item < count_ + facet_.size()) {
      const std::size_t facet = at(facet_[item - count_]);
      if constexpr (width == 4) {
        for (const std::size_t k : facets[facet % 4]) put(corner(facet / 4, k));
      }
    } else {
      for (const std::int32_t v : edges_[item - count_ - facet_.size()]) put(v);
    }
    return s;
  }

  // By Euler, of cells that fill a convex hull.
  std::size_t expected_edges() const {
    return cells_.size() == 0 ? 0 : order_.size() + (width == 4 ? facet_.size() - cells_.size() : count_) - 1;
  }

  void measure_cells(LargeArray<std::uint8_t>& cut, LargeArray<std::uint8_t>& cut_sides) {
    for_pieces(cells_.size(), simplices_a_piece, threads_, passes_.next(),
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 if constexpr (width == 4) {
                   measure_tetrahedra(scaled_, {cells_.data() + begin, end - begin},
                                      {value_.data() + begin, cut.data() + begin, cut_sides.data() + begin});
                 } else if constexpr (width == 3) {
                   measure_simplices<3>(scaled_, {cells_.data() + begin, end - begin}, value_.data() + begin);
                   for (std::size_t t = begin; t < end; ++t) cut_sides[t] = sides_cut(cells_[t]);
                 } else {
                   std::fill(cut_sides.data() + begin, cut_sides.data() + end, std::uint8_t{0});
                 }
               });
  }

  // The sides of a triangle such that the opposite corner is strictly inside the sphere on them as diameter.
  std::uint8_t sides_cut(const Cell& cell) const {
    unsigned result = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
      if (is_inside_diametral_sphere(point(cell[a]), point(cell[b]), point(cell[k]), scaled_.are_integers))
        result |= 1U << side_between[a][b];
    }
    return static_cast<std::uint8_t>(result);
  }

  void measure_facets(const LargeArray<std::uint8_t>& cut) {
    const auto is_cut = [&](std::int32_t facet) {
      return facet >= 0 && (cut[at(facet) / 4] >> (facet % 4) & 1) != 0;
    };
    measure<3>(
        count_, facet_.size(),
        [&](std::size_t m) {
          const Cell& cell = cells_[at(facet_[m]) / 4];
          const auto& [a, b, c] = facets[at(facet_[m]) % 4];
          return Corners{cell[a], cell[b], cell[c]};
        },
        [&](std::size_t m) {
          return std::size_t{is_cut(facet_[m])} | std::size_t{is_cut(facets_->across(facet_[m]))};
        });
  }

  // The values of those simplices of a kind that nothing cuts.
  template <std::size_t size, class CornersOf, class IsCut>
  void measure(std::size_t first_item, std::size_t count, const CornersOf& corners_of, const IsCut& is_cut) {
    for_pieces(count, simplices_a_piece, threads_, passes_.next(),
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 std::vector<std::array<std::int32_t, size>> gabriel(end - begin + 1);
                 std::vector<std::size_t> item(gabriel.size());
                 std::size_t found = 0;
                 for (std::size_t m = begin; m < end; ++m) {  // without a branch
                   gabriel[found] = corners_of(m);
                   item[found] = first_item + m;
                   value_[first_item + m] = left_out;
                   found += 1 - is_cut(m);
                 }
                 std::vector<double> radius(found);
                 measure_simplices<size>(scaled_, {gabriel.data(), found}, radius.data());
                 for (std::size_t i = 0; i < found; ++i) value_[item[i]] = radius[i];
               });
  }

  SpaceArrays write(alpha::RadiusRanks&& ranks) {
    SpaceArrays out;
    // In the memory that ranks leave, if there is enough; the complement where nothing is across.
    const std::size_t items = count_ + facet_.size() + edges_.size();
    LargeArray<std::int32_t> more(4 * count_ <= items ? 0 : 4 * count_);
    std::int32_t* const facet_min = 4 * count_ <= items ? ranks.rank.data() + items : more.data();
    out.triangle_min = LargeArray<std::int32_t>(facet_.size());
    for_items(facet_.size(), simplices_a_piece, threads_, passes_.next(), [&](std::size_t m) {
      const std::int32_t own = ranks.rank[count_ + m], facet = facet_[m], other = facets_->across(facet);
      std::int32_t least = std::min(own, ranks.rank[at(facet) / 4]);
      if (other >= 0) least = std::min(least, ranks.rank[at(other) / 4]);
      out.triangle_min[m] = least;
      facet_min[at(facet)] = other < 0 ? ~least : least;
      if (other >= 0) facet_min[at(other)] = least;
    });
    for (LargeArray<std::int32_t>* each : {&out.edge_min, &out.edge_mid, &out.edge_max})
      *each = LargeArray<std::int32_t>(edges_.size());
    stars_.visit([&] { return EdgeRanks(*this, edges_, out, ranks, facet_min); });
    out.edges = std::move(edges_);
    (width == 4 ? out.tetrahedron_rank : out.triangle_min) = LargeArray<std::int32_t>(count_);
    copy(ranks.rank.data(), (width == 4 ? out.tetrahedron_rank : out.triangle_min).data());
    out.facet = std::move(facet_);
    out.spectrum = std::move(ranks.value);
    out.witness = std::move(ranks.witness);
    return out;
  }

  template <class Item>
  void copy(const Item* from, Item* to) const {
    for_pieces(count_, values_a_piece, threads_, passes_.same(),
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 std::copy(from + begin, from + end, to + begin);
               });
  }

  // The ranks of the edges of a block, from those of the cells around them.
  class EdgeRanks {
   public:
    EdgeRanks(const Builder& builder, LargeArray<Ends>& edges, SpaceArrays& out,
              const alpha::RadiusRanks& ranks, const std::int32_t* facet_min)
        : builder_(builder),
          edges_(edges),
          out_(out),
          rank_(ranks.rank),
          facet_min_(facet_min),
          last_rank_(static_cast<std::int32_t>(ranks.value.size())) {}

    void start(std::size_t first, std::size_t last) {
      found_.assign(last - first, Ranks{last_rank_, last_rank_, width == 4 ? -1 : ~last_rank_, 0});
    }

    void prefetch(std::size_t t) const {
      if constexpr (width == 4) __builtin_prefetch(&facet_min_[4 * t]);
      if constexpr (width > 2) __builtin_prefetch(&rank_[t]);
    }

    template <class Number>
    void visit(std::size_t t, const CornerOrder<width>& order, unsigned in_block, const Number*& edge) {
      const std::int32_t own = width == 2 ? 0 : rank_[t];
      std::array<std::int32_t, 4> least{}, most{own, own, own, own};
      if constexpr (width == 4) {
        const std::int32_t* const facet = facet_min_ + 4 * t;
        least = {facet[order[0]], facet[order[1]], facet[order[2]], facet[order[3]]};
        if ((least[0] | least[1] | least[2] | least[3]) < 0) mark_outside(least, most);
      }
      EdgeStars<width>::for_places(in_block, [&](auto place) {
        for (std::size_t later = place + 1; later < width; ++later) {
          Ranks ranks{own, last_rank_, ~last_rank_, 0};
          if constexpr (width == 4) {  // the facets opposite to the other corners are at the edge
            const auto& [p, q] = besides[place][later];
            ranks = Ranks{std::min(least[p], least[q]), own, ~std::max(most[p], most[q]), 0};
          }
          Ranks& found = found_[*edge++];
          if constexpr (width > 2) found = ranks < found ? ranks : found;
        }
      });
    }

    void end(std::size_t first, std::size_t last) {
      const std::size_t items = builder_.count_ + builder_.facet_.size();
      for (std::size_t e = first; e < last; ++e) {
        const Ranks& found = found_[e - first];
        out_.edge_min[e] = std::min(found[0], rank_[items + e]);
        out_.edge_mid[e] = found[1], out_.edge_max[e] = ~found[2];
        const auto [a, b] = edges_[e];
        const auto [p, q] = std::minmax(builder_.order_[at(a)], builder_.order_[at(b)]);
        edges_[e] = {p, q};
      }
    }

   private:
    // Of an edge the least and the middle rank, and the complement of the greatest: what is found makes them less.
    typedef std::int32_t Ranks __attribute__((vector_size(16)));

    // The two other corners than two.
    static constexpr std::array<std::array<std::array<std::size_t, 2>, 4>, 3> besides{
        {{{{}, {2, 3}, {1, 3}, {1, 2}}}, {{{}, {}, {0, 3}, {0, 2}}}, {{{}, {}, {}, {0, 1}}}}};

    // Complements belong to facets that nothing is across.
    void mark_outside(std::array<std::int32_t, 4>& least, std::array<std::int32_t, 4>& most) const {
      for (std::size_t k = 0; k < 4; ++k) {
        if (least[k] < 0) least[k] = ~least[k], most[k] = last_rank_;
      }
    }

    const Builder& builder_;
    LargeArray<Ends>& edges_;  // which get the old numbers
    SpaceArrays& out_;
    const LargeArray<std::int32_t>& rank_;
    const std::int32_t* facet_min_;
    std::int32_t last_rank_;
    std::vector<Ranks> found_;  // of the edges
  };

  std::size_t count_;  // of cells that are ranked
  std::span<const Row> neighbors_;
  unsigned threads_;
  base::Passes passes_;
  std::optional<Facets> facets_;     // of tetrahedra
  LargeArray<Cell> cells_;           // by the new numbers
  std::vector<std::int32_t> place_;  // the new numbers
  std::vector<std::int32_t> order_;  // the old numbers
  EdgeStars<width> stars_;
  ScaledPoints scaled_;
  std::span<const Cell> given_;  // by the old numbers
  LargeArray<std::int32_t> facet_;
  LargeArray<Ends> edges_;    // by the new numbers
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
