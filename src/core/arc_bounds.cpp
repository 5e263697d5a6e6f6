#include "core/arc_bounds.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "core/parallel.hpp"
#include "core/site_hierarchy.hpp"

namespace vorotool::core {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double node_error = 0x1p-21;  // nodes are rounded to doubles below 2^31
constexpr int most_halvings = 6;
constexpr double most_parts = 16;  // of a piece at a time

double distance(const Place& p, const Place& q) {
  const double x = p[0] - q[0], y = p[1] - q[1];
  return std::sqrt(x * x + y * y);
}
Place place_of(const Point& p) { return {p.x, p.y}; }

double distance(const Place& p, const LatticeSite& edge) {
  const Place a{static_cast<double>(edge.a.x), static_cast<double>(edge.a.y)};
  const double x = p[0] - a[0], y = p[1] - a[1];
  const LatticeVector along = edge.b - edge.a;
  const double ux = static_cast<double>(along.x), uy = static_cast<double>(along.y),
               square = ux * ux + uy * uy;
  const double t = ux * x + uy * y;
  if (t <= 0 || square == 0) return std::sqrt(x * x + y * y);
  if (t >= square) return distance(p, Place{static_cast<double>(edge.b.x), static_cast<double>(edge.b.y)});
  return std::abs(ux * y - uy * x) / std::sqrt(square);
}

// What is known of an arc while it is bounded.
class Bounder {
 public:
  Bounder(const SeedDiagram& diagram, const SiteHierarchy* hierarchy)
      : diagram_(diagram), hierarchy_(hierarchy), near_(diagram, hierarchy) {}

  // Nothing if that takes a hierarchy.
  std::optional<ArcBound> operator()(const BoundedArc& arc) {
    needs_hierarchy_ = false;
    most_ = -1;
    arc_ = &arc;
    pieces_.clear();
    for (std::size_t i = 0; i < 2; ++i) found_.radius[i] = distance(arc.place[i], place_of(seed(arc.seed)));
    found_.error = node_error;  // all there is where the seeds are on one line: they are the ends of edges
    if (arc.side < 0) return found_;
    set_seeds();
    found_.error += arc.corner < 0 ? bound(arc.place[0], arc.place[1], 0) : bound_from_corner();
    if (needs_hierarchy_) return {};
    return found_;
  }

  // Asks for shorter pieces where the last arc is.
  void demand(double tolerance, std::span<std::int32_t> parts) const {
    double longest = 0;
    for (const Side s : pieces_) longest = std::max(longest, length(s));
    const double wanted = std::isfinite(found_.error) ? 1.05 * std::sqrt(found_.error / tolerance) : 2;
    const double most = longest / std::clamp(wanted, 1.05, most_parts);
    for (const Side s : pieces_) {
      const std::int32_t piece = diagram_.labels().piece_between(mesh().origin(s), mesh().target(s));
      std::atomic_ref<std::int32_t> count(parts[static_cast<std::size_t>(piece)]);
      const auto own = static_cast<std::int32_t>(std::ceil(length(s) / most));
      std::int32_t so_far = count.load(std::memory_order_relaxed);
      while (so_far < own && !count.compare_exchange_weak(so_far, own, std::memory_order_relaxed)) {
      }
    }
  }

 private:
  const SeedMesh& mesh() const { return diagram_.mesh(); }
  const Point& seed(std::int32_t s) const { return mesh().seed(s); }
  double length(Side s) const {
    return distance(place_of(seed(mesh().origin(s))), place_of(seed(mesh().target(s))));
  }

  // The seeds of the arc, and the reach: a quarter of the longest gap beside them.
  void set_seeds() {
    double longest = 0;
    const std::array<std::int32_t, 2> own{mesh().origin(arc_->side), mesh().target(arc_->side)};
    for (std::size_t i = 0; i < 2; ++i) {
      labels_[i].clear();
      diagram_.labels().visit(own[i], [&](std::int32_t segment) { labels_[i].push_back(segment); });
      seeds_[i] = {seed(own[i]), labels_[i]};
      diagram_.labels().visit_beside(own[i], [&](std::int32_t other) {
        longest = std::max(longest, distance(place_of(seed(other)), place_of(seed(own[i]))));
      });
    }
    reach_ = longest / 4;
  }

  // The square of the radius of a disc about a place that is so far from its seeds.
  double wide_square(double radius) const {
    return radius * radius + reach_ * reach_ + 0x1p-18 * (radius + 1);
  }

  double bound(const Place& a, const Place& b, int halvings) {
    const Place own = place_of(seeds_[0].place);
    const auto near =
        near_.find(arc_->side, {{a, b}, {wide_square(distance(a, own)), wide_square(distance(b, own))}});
    if (near) {
      note_radius(a, b, *near);
      return noted(axis_(a, b, seeds_, *near, reach_));
    }
    if (halvings == most_halvings) return noted(crowded_bound(a, b));
    const Place middle{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
    const double first = bound(a, middle, halvings + 1);
    return std::max(first, bound(middle, b, halvings + 1));
  }

  void note_radius(const Place& a, const Place& b, std::span<const NearEdge> near) {
    for (std::size_t i = 0; i < 2; ++i) {
      if (arc_->place[i] != (i == 0 ? a : b)) continue;
      for (const NearEdge& edge : near) {
        found_.radius[i] = std::min(found_.radius[i], distance(arc_->place[i], edge.site));
      }
    }
  }

  // Keeps the pieces that the largest bound comes from.
  double noted(double error) {
    if (error > most_) {
      most_ = error;
      pieces_.assign(near_.pieces().begin(), near_.pieces().end());
    }
    return error;
  }

  // Where very many edges are near, any one may be the nearest. Of two seeds one is seen half their angle
  // away from it, and the disc that grows away from it (core/axis_bound.hpp) meets that.
  double crowded_bound(const Place& a, const Place& b) {
    if (hierarchy_ == nullptr) {
      needs_hierarchy_ = true;
      return infinity;
    }
    const Place own = place_of(seeds_[0].place);
    const double radius = std::max(distance(a, own), distance(b, own)), length = distance(a, b);
    const double clearance = (clearance_of(a, radius) + clearance_of(b, radius) - length) / 2;
    if (!(clearance > 0)) return infinity;
    double least = infinity;
    for (const Triangle t : near_.triangles()) {
      for (int k = 0; k < 3; ++k) {
        const Place other = place_of(seed(mesh().corner(t, k)));
        const double far = std::max({radius, distance(a, other), distance(b, other)}) + node_error;
        const double denominator =
            clearance - far * cosine_of_half_angle(a, b, own, other, length / clearance);
        if (denominator > 0) least = std::min(least, (far * far - clearance * clearance) / (2 * denominator));
      }
    }
    return least;
  }

  double clearance_of(const Place& place, double radius) const {
    const double slack = std::min(0x1p-10, reach_ * reach_ / (4 * radius * radius));
    return hierarchy_->nearest(place[0], place[1], slack, [&](std::uint32_t segment) {
      return distance(place, diagram_.labels().graph().site(static_cast<std::int32_t>(segment)));
    });
  }

  // Of the angle at which two places are seen from a and b and between, where directions turn by `turn` at
  // most.
  static double cosine_of_half_angle(const Place& a, const Place& b, const Place& p, const Place& q,
                                     double turn) {
    const Place x{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
    const double cosine =
        ((p[0] - x[0]) * (q[0] - x[0]) + (p[1] - x[1]) * (q[1] - x[1])) / (distance(x, p) * distance(x, q));
    return std::sqrt(std::max(0.0, 1 + cosine) / 2) + turn + 0x1p-24;
  }

  // A line from a corner along the bisector of its edges. Everything about these two grows with the distance
  // from the corner, errors and what they are compared with: as long as no other edge comes near, the bound
  // at a place holds for all up to it.
  double bound_from_corner() {
    const auto& [corner, target] = arc_->place;
    const double radius = distance(corner, target);
    const double square = wide_square(radius + reach_);  // holds the discs about the places before, as wide
    const auto near = near_.find(arc_->side, {{target, target}, {square, square}});
    found_.radius = {0, radius};
    if (!near) return noted(infinity);
    note_radius(corner, target, *near);
    found_.radius[0] = 0;
    double share = 0.5;
    for (int halvings = 0; halvings < 2 * most_halvings; ++halvings, share /= 2) {
      const Place from{corner[0] + share * (target[0] - corner[0]),
                       corner[1] + share * (target[1] - corner[1])};
      if (has_only_corner(*near, from, share * radius)) return noted(axis_(from, target, {}, *near, reach_));
    }
    return noted(infinity);
  }

  bool has_only_corner(std::span<const NearEdge> near, const Place& centre, double radius) const {
    const ShapeGraph& graph = diagram_.labels().graph();
    return std::all_of(near.begin(), near.end(), [&](const NearEdge& edge) {
      if (edge.segment >= 0) {
        const auto& ends = graph.ends(edge.segment);
        if (ends[0] == arc_->corner || ends[1] == arc_->corner) return true;
      }
      return distance(centre, edge.site) > radius + reach_;
    });
  }

  const SeedDiagram& diagram_;
  const SiteHierarchy* hierarchy_;
  NearEdges near_;
  AxisBound axis_;
  const BoundedArc* arc_ = nullptr;
  std::array<std::vector<std::int32_t>, 2> labels_;
  std::array<ArcSeed, 2> seeds_;
  double reach_ = 0, most_ = -1;
  std::vector<Side> pieces_;
  ArcBound found_;
  bool needs_hierarchy_ = false;
};

SiteHierarchy hierarchy_of(const SeedDiagram& diagram, unsigned threads, const Monitor& monitor) {
  const ShapeGraph& graph = diagram.labels().graph();
  std::vector<LatticeSite> sites;
  for (std::size_t j = 0; j < graph.segments.size(); ++j)
    sites.push_back(graph.site(static_cast<std::int32_t>(j)));
  return {sites, threads, monitor};
}

}  // namespace

std::vector<ArcBound> arc_bounds(const SeedDiagram& diagram, std::span<const BoundedArc> arcs,
                                 double tolerance, std::span<std::int32_t> parts, unsigned threads,
                                 const Monitor& monitor) {
  constexpr std::size_t grain = 1 << 12;
  std::vector<ArcBound> bounds(arcs.size());
  std::optional<SiteHierarchy> hierarchy;
  if (!diagram.walked_pieces().empty()) hierarchy.emplace(hierarchy_of(diagram, threads, monitor));
  std::vector<std::vector<std::size_t>> left_over(piece_count(arcs.size(), grain));
  const auto bound_one = [&](Bounder& bounder, std::size_t i) {
    const std::optional<ArcBound> found = bounder(arcs[i]);
    if (!found) return false;
    bounds[i] = *found;
    if (!parts.empty() && !(found->error <= tolerance)) bounder.demand(tolerance, parts);
    return true;
  };
  const auto run = [&](std::size_t piece) {
    Bounder bounder(diagram, hierarchy ? &*hierarchy : nullptr);
    for (std::size_t i = piece * grain; i < std::min(arcs.size(), (piece + 1) * grain); ++i) {
      if (!bound_one(bounder, i)) left_over[piece].push_back(i);
    }
  };
  parallel_for(left_over.size(), threads, run, monitor);
  if (std::all_of(left_over.begin(), left_over.end(), [](const auto& few) { return few.empty(); }))
    return bounds;
  hierarchy.emplace(hierarchy_of(diagram, threads, monitor));
  parallel_for(
      left_over.size(), threads,
      [&](std::size_t piece) {
        Bounder bounder(diagram, &*hierarchy);
        for (const std::size_t i : left_over[piece]) bound_one(bounder, i);
      },
      monitor);
  return bounds;
}

}  // namespace vorotool::core
