#include "core/sampled_skeleton/error_bounds.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "core/base/atomic_ref.hpp"
#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/numbers/special_values.hpp"
#include "core/sampled_skeleton/near_edges.hpp"
#include "core/spatial/clearance.hpp"
#include "core/spatial/obb_tree.hpp"

namespace vorotool::core::sampled_skeleton {

using kernel::LatticeSite;
using kernel::Point;
using numbers::infinity;
using spatial::ObbTree;

namespace {

constexpr double node_error = 0x1p-21;  // nodes are rounded to doubles below 2^31
constexpr int most_halvings = 48;
constexpr std::size_t few_edges = 12, many_edges = 64;  // near a disc: more is another case
constexpr double most_parts = 16;                       // of a piece at a time

double power_above(double value) {
  int exponent = 0;
  std::frexp(value, &exponent);
  return value > 0 ? std::ldexp(1.0, exponent) : 0;
}

// To the precision of a float: what differs by its last bits only becomes the same, nearly always.
double rounded_up(double value) { return static_cast<float>(value * (1 + 0x1p-22)); }

// The state of an arc while it is bounded.
class Bounder {
 public:
  Bounder(const SampleDiagram& diagram, std::span<const NearEdge> items, const ObbTree& hierarchy)
      : diagram_(diagram),
        items_(items),
        hierarchy_(hierarchy),
        near_(items, hierarchy, few_edges),
        nearest_(items, hierarchy, many_edges) {}

  const ErrorBound& operator()(const BoundedArc& arc) {
    arc_ = &arc;
    for (std::size_t i = 0; i < 2; ++i) found_.radius[i] = norm(arc.place[i] - seed(arc.seed));
    found_.error = node_error;  // all there is where the seeds are on one line: they are the ends of edges
    if (arc.side < 0) return found_;
    set_seeds();
    origin_ = seed(arc.seed);
    most_ = -1;
    found_.error += arc.corner < 0 ? bound(arc.place[0], arc.place[1], 0) : bound_from_corner();
    return found_;
  }

  // Asks for shorter pieces of the edges that are near the last arc, where they are nearest to it.
  void demand(double tolerance, std::span<std::int32_t> parts) const {
    std::vector<std::pair<std::int32_t, double>> pieces;  // with their lengths
    double longest = 0;
    for (const std::int32_t segment : wanting_) {
      diagram_.labels().visit_pieces(segment, foot(segment, 0), foot(segment, 1), [&](std::int32_t piece) {
        const EdgePiece ends = diagram_.labels().piece(piece);
        pieces.push_back({piece, norm(seed(ends.first) - seed(ends.last))});
        longest = std::max(longest, pieces.back().second);
      });
    }
    const double wanted = std::isfinite(found_.error) ? 1.05 * std::sqrt(found_.error / tolerance) : 2;
    const double most = longest / std::clamp(wanted, 1.05, most_parts);
    for (const auto& [piece, length] : pieces) {
      base::atomic_ref<std::int32_t> count(parts[static_cast<std::size_t>(piece)]);
      const auto own = static_cast<std::int32_t>(std::ceil(length / most));
      std::int32_t so_far = count.load(std::memory_order_relaxed);
      while (so_far < own && !count.compare_exchange_weak(so_far, own, std::memory_order_relaxed)) {
      }
    }
  }

 private:
  const SampleMesh& mesh() const { return diagram_.mesh(); }
  const kernel::Point& seed(std::int32_t s) const { return mesh().seed(s); }
  // How far along a segment the foot of an end of the arc is, as a share of its length.
  double foot(std::int32_t segment, std::size_t end) const {
    const LatticeSite site = diagram_.labels().graph().segment(base::at(segment));
    const kernel::LatticeVector along = site.b - site.a;
    const double ux = static_cast<double>(along.x), uy = static_cast<double>(along.y);
    const double x = arc_->place[end].x - site.a.x, y = arc_->place[end].y - site.a.y;
    return (ux * x + uy * y) / (ux * ux + uy * uy);
  }

  // The seeds of the arc, and the reach: the least power of two above a quarter of the longest gap beside
  // them, so that arcs that follow each other have the same.
  void set_seeds() {
    double longest = 0;
    const base::IndexPair own{mesh().origin(arc_->side), mesh().target(arc_->side)};
    for (std::size_t i = 0; i < 2; ++i) {
      labels_[i].clear();
      diagram_.labels().visit(own[i], [&](std::int32_t segment) { labels_[i].push_back(segment); });
      seeds_[i] = {seed(own[i]), labels_[i]};
      diagram_.labels().visit_beside(
          own[i], [&](std::int32_t other) { longest = std::max(longest, norm(seed(other) - seed(own[i]))); });
    }
    reach_ = power_above(longest / 4);
  }

  // How far a place is from the seeds, or from the corner that the arc leads to.
  double radius(const Point& p) const { return norm(p - origin_); }

  // A disc about a place that holds what counts besides the nearest edges: those near to where these are
  // nearest (core/sampled_skeleton/arc_error_bound.hpp). Discs about places on the arc are within those about
  // its ends: those through two seeds, and, squared, larger by the same; of a line from a corner the one
  // about its target holds all.
  double wide_radius(const Point& p) const {
    const double own = radius(p);
    return arc_->corner < 0 ? rounded_up(std::sqrt(own * own + reach_ * reach_)) : own + reach_;
  }

  double bound(const Point& a, const Point& b, int halvings) {
    if (const auto near = near_.find({{a, b}, {wide_radius(a), wide_radius(b)}})) {
      note_radius(a, b, *near);
      return noted(axis_(a, b, seeds(), *near, reach_, ArcErrorBound::clearing_among(*near)), *near);
    }
    if (const auto nearest = nearest_.find({{a, b}, label_radii(a, b)})) {
      note_radius(a, b, *nearest);
      return noted(axis_(a, b, seeds(), *nearest, reach_, local_clearing()), *nearest);
    }
    if (halvings == most_halvings || (nearest_.is_crowded(0) && nearest_.is_crowded(1))) {
      return noted(crowded_bound(a, b), {});
    }
    const Point middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
    const double first = bound(a, middle, halvings + 1);
    return std::max(first, bound(middle, b, halvings + 1));
  }

  std::span<const ArcSample> seeds() const {
    return arc_->corner < 0 ? std::span<const ArcSample>(seeds_) : std::span<const ArcSample>();
  }

  // Discs that all edges meet which are nearest somewhere between: no farther than an edge L of the arc. The
  // distance of L is at most its chord; that of another edge, at least m at the ends, is convex and bends by
  // at most 1 / (m - l) over a length l, so that it is below its chord by no more than l^2 / (8 (m - l)).
  std::array<double, 2> label_radii(const Point& a, const Point& b) const {
    std::array<double, 2> least{radius(a), radius(b)};
    const double length = norm(a - b);
    for (const auto& labels : labels_) {
      for (const std::int32_t segment : labels) {
        const LatticeSite site = diagram_.labels().graph().segment(base::at(segment));
        const std::array<double, 2> own{spatial::closed_distance(site, a), spatial::closed_distance(site, b)};
        const double rest = std::min(own[0], own[1]) - length;
        const double more = length * length / (8 * rest) + node_error;
        if (rest > 0 && own[0] + own[1] + 2 * more < least[0] + least[1])
          least = {own[0] + more, own[1] + more};
      }
    }
    return least;
  }

  // By what is found near the feet.
  ArcErrorBound::Clearing local_clearing() const {
    return [this](const Point& first, const Point& last, std::int32_t segment, double reach) {
      const Point middle{(first.x + last.x) / 2, (first.y + last.y) / 2};
      double least = reach;
      hierarchy_.near(middle.x, middle.y, norm(first - last) / 2 + reach, [&](std::uint32_t item) {
        const double other =
            ArcErrorBound::clearing_among(items_.subspan(item, 1))(first, last, segment, reach);
        least = std::min(least, other);
        return least > 0;
      });
      return least;
    };
  }

  void note_radius(const Point& a, const Point& b, std::span<const NearEdge> near) {
    for (std::size_t i = 0; i < 2; ++i) {
      if (arc_->place[i] != (i == 0 ? a : b)) continue;
      for (const NearEdge& edge : near) {
        found_.radius[i] = std::min(found_.radius[i], spatial::closed_distance(edge.site, arc_->place[i]));
      }
    }
  }

  // Keeps the edges that the largest bound comes from.
  double noted(double error, std::span<const NearEdge> near) {
    if (error > most_) {
      most_ = error;
      wanting_.clear();
      for (const NearEdge& edge : near) {
        if (edge.segment >= 0) wanting_.push_back(edge.segment);
      }
      for (const auto& labels : labels_) wanting_.insert(wanting_.end(), labels.begin(), labels.end());
    }
    return error;
  }

  // Where very many edges are about as near, any one may be the nearest, in a place f at the distance d. For
  // any fixed place p, |x - p|^2 - d^2 is the largest of linear functions of x, one for each f: it is convex,
  // and so largest at an end. Of two places that edges go through one is seen at no less than half of their
  // angle from f, and the disc that grows away from f (core/sampled_skeleton/arc_error_bound.hpp) meets that.
  double crowded_bound(const Point& a, const Point& b) {
    const double at_a = clearance_of(a), at_b = clearance_of(b);
    const double excess = std::max(radius(a) * radius(a) - at_a * at_a, radius(b) * radius(b) - at_b * at_b) +
                          radius(a) * node_error;
    const double own = closed_distance(origin_, a, b), clearance = std::sqrt(own * own - excess);
    if (!(clearance > 0)) return infinity;
    double least = infinity;
    for (const std::int32_t s : seeds_around()) {
      const Point other = seed(s);
      const double cosine = cosine_of_half_angle(a, b, origin_, other, norm(a - b) / clearance);
      double grown = 0;
      for (const Point& place : {origin_, other}) {
        const double far = std::max(norm(a - place), norm(b - place)) + node_error;
        const double height = clearance - far * cosine;
        const double more = std::max(excess_of(a, place), excess_of(b, place)) + excess;
        grown = std::max(grown, height > 0 ? more / (2 * height) : infinity);
      }
      least = std::min(least, grown);
    }
    return least;
  }

  // |x - g|^2 less the square of the radius.
  double excess_of(const Point& x, const Point& g) const {
    const double far = norm(x - g), own = radius(x);
    return (far - own) * (far + own);
  }

  // Of some triangles around the side: where very many seeds are at one distance these lead across the disc.
  std::vector<std::int32_t> seeds_around() const {
    constexpr std::size_t most = 64;
    std::vector<Triangle> triangles{SampleMesh::triangle_of(arc_->side)};
    std::vector<std::int32_t> seeds;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      for (Side s = 3 * triangles[i]; s < 3 * triangles[i] + 3; ++s) {
        seeds.push_back(mesh().apex(s));
        const Triangle across = mesh().across(s);
        const bool is_new = std::find(triangles.begin(), triangles.end(), across) == triangles.end();
        if (across >= 0 && is_new && triangles.size() < most) triangles.push_back(across);
      }
    }
    return seeds;
  }

  // Not more than the clearance, and hardly less.
  double clearance_of(const Point& place) const {
    const double share = reach_ / radius(place);
    return hierarchy_.nearest(
        place.x, place.y, std::min(0x1p-10, share * share / 16),
        [&](std::uint32_t item) { return spatial::closed_distance(items_[item].site, place); });
  }

  // Of the angle at which two places are seen from a and b and between, where directions turn by `turn` at
  // most.
  static double cosine_of_half_angle(const Point& a, const Point& b, const Point& p, const Point& q,
                                     double turn) {
    const Point x{(a.x + b.x) / 2, (a.y + b.y) / 2};
    const double cosine = dot(p - x, q - x) / (norm(x - p) * norm(x - q));
    return std::sqrt(std::max(0.0, 1 + cosine) / 2) + turn + 0x1p-24;
  }

  // A line from a corner along the bisector of its edges. Everything about these two grows with the distance
  // from the corner, errors and what they are compared with: the bound at a place holds for all up to it, if
  // no other edge meets the discs about them, widened by their errors, which are at most their radii.
  double bound_from_corner() {
    const auto& [corner, target] = arc_->place;
    const double length = norm(corner - target);
    double share = 0.5;
    while (share > 0x1p-60 && !has_only_corner(3 * share * length)) share /= 2;
    const Point from{corner.x + share * (target.x - corner.x), corner.y + share * (target.y - corner.y)};
    found_.radius[0] = 0;
    return bound(from, target, 0);
  }

  // Whether no edge is that near to the corner but those that end there.
  bool has_only_corner(double radius) const {
    const kernel::PlanarGraphView& graph = diagram_.labels().graph();
    bool has_only = true;
    hierarchy_.near(origin_.x, origin_.y, radius, [&](std::uint32_t item) {
      const std::int32_t segment = items_[item].segment;
      const bool is_own =
          segment >= 0 && std::ranges::count(graph.segments[base::at(segment)], arc_->corner) > 0;
      has_only = is_own || spatial::closed_distance(items_[item].site, origin_) > radius;
      return has_only;
    });
    return has_only;
  }

  const SampleDiagram& diagram_;
  std::span<const NearEdge> items_;
  const ObbTree& hierarchy_;
  NearEdges near_, nearest_;
  ArcErrorBound axis_;
  const BoundedArc* arc_ = nullptr;
  std::array<std::vector<std::int32_t>, 2> labels_;
  std::array<ArcSample, 2> seeds_;
  Point origin_{0, 0};
  double reach_ = 0, most_ = -1;
  std::vector<std::int32_t> wanting_;  // segments
  ErrorBound found_;
};

std::vector<LatticeSite> sites_of(std::span<const NearEdge> items) {
  std::vector<LatticeSite> sites;
  for (const NearEdge& item : items) sites.push_back(item.site);
  return sites;
}

}  // namespace

void bound_arcs(const SampleDiagram& diagram, const ArcsToBound& arcs, double tolerance,
                std::span<std::int32_t> parts, unsigned threads, const base::Monitor& monitor) {
  constexpr std::size_t grain = 1 << 11;
  const std::vector<std::vector<NearEdge>> items =
      NearEdges::items(diagram.labels().graph(), diagram.groups());
  std::vector<ObbTree> hierarchies;
  for (const auto& own : items) {
    hierarchies.emplace_back(sites_of(own), own.size() < grain ? 1 : threads, monitor);
  }
  const auto bound_piece = [&](std::size_t, std::size_t begin, std::size_t end) {
    std::optional<Bounder> bounder;
    std::size_t group = items.size();  // of the bounder
    for (std::size_t i = begin; i < end; ++i) {
      const BoundedArc arc = arcs.arc(i);
      if (const auto own = static_cast<std::size_t>(diagram.group_of(arc.seed)); own != group) {
        bounder.emplace(diagram, items[own], hierarchies[own]);
        group = own;
      }
      const ErrorBound& bound = (*bounder)(arc);
      arcs.take(i, bound);
      if (!parts.empty() && !(bound.error <= tolerance)) bounder->demand(tolerance, parts);
    }
  };
  base::for_pieces(arcs.count, grain, threads, monitor, bound_piece);
}

}  // namespace vorotool::core::sampled_skeleton
