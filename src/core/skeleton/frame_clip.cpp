#include "core/skeleton/frame_clip.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/kernel/lattice.hpp"
#include "core/numbers/special_values.hpp"

namespace vorotool::core::skeleton {
using kernel::Point;
using numbers::infinity;

namespace {

class Clipper {
 public:
  Clipper(SkeletonGraph& graph, const Frame& frame, std::vector<GraphArc>& kept)
      : graph_(graph), frame_(frame), kept_(kept) {}

  void clip(const GraphArc& arc) {
    const BisectorArc bisector = graph_.bisector(arc);
    if (arc.source >= 0 && arc.target >= 0) {
      const ArcEnd source = graph_.end(arc.source), target = graph_.end(arc.target);
      if (is_inside(bisector, source, target)) {
        kept_.push_back(arc);
        return;
      }
      if (bisector.is_parabola) {
        clip_parabola(arc, bisector.parabola, source, target);
        return;
      }
    }
    clip_line(arc, line_of(arc));
  }

 private:
  // An arc stays within the triangle of its ends and its control point.
  bool is_inside(const BisectorArc& bisector, const ArcEnd& source, const ArcEnd& target) const {
    return frame_.holds(source.place) && frame_.holds(target.place) &&
           (!bisector.is_parabola || frame_.holds(control_point(bisector.parabola, source, target)));
  }

  // Only the bisectors of two points, and of a segment and its end, are unbounded: across the way between
  // them, the left site to the left.
  Line line_of(const GraphArc& arc) const {
    if (arc.source >= 0 && arc.target >= 0) {
      // from the nearer end: the other one may be so far away that its rounding would move what is in the
      // frame
      const Point a = graph_.end(arc.source).place, b = graph_.end(arc.target).place;
      const Point way{b.x - a.x, b.y - a.y};
      const auto size = [](const Point& p) { return std::max(std::abs(p.x), std::abs(p.y)); };
      return size(a) <= size(b) ? Line{a, way, 0, 1} : Line{b, way, -1, 0};
    }
    const kernel::LatticeSite left = graph_.diagram().site(arc.left),
                              right = graph_.diagram().site(arc.right);
    const kernel::LatticePoint p = left.is_point() ? left.a : right.a,
                               q = right.is_point() ? right.a : left.a;
    const auto middle_of = [](const kernel::LatticeSite& s) {
      return kernel::LatticeVector{std::int64_t{s.a.x} + s.b.x, std::int64_t{s.a.y} + s.b.y};
    };
    const kernel::LatticeVector across{middle_of(left).x - middle_of(right).x,
                                       middle_of(left).y - middle_of(right).y};
    const Point way{static_cast<double>(across.y), -static_cast<double>(across.x)};
    const Point middle{(static_cast<double>(p.x) + q.x) / 2, (static_cast<double>(p.y) + q.y) / 2};
    const auto parameter = [&](std::int32_t node) {
      const Point end = graph_.end(node).place;
      return dot(end - middle, way) / dot(way, way);
    };
    return {middle, way, arc.source >= 0 ? parameter(arc.source) : -infinity,
            arc.target >= 0 ? parameter(arc.target) : infinity};
  }

  void clip_line(const GraphArc& arc, const Line& line) {
    const auto cuts = cut_line(line, frame_);
    if (!cuts) return;
    const auto& [first, last] = *cuts;
    const auto node = [&](const Cut& cut, std::int32_t own) {
      if (cut.side == FrameSide::none) return own;
      const Point place = line.place(cut.t);
      return graph_.add_node({place, distance_to(graph_.diagram().site(arc.left), place)}, cut.side);
    };
    kept_.push_back({node(first, arc.source), node(last, arc.target), arc.left, arc.right, arc.group});
  }

  // Between two cuts in a row the parabola is inside, or outside.
  void clip_parabola(const GraphArc& arc, const Parabola& p, const ArcEnd& source, const ArcEnd& target) {
    const double from = p.parameter(source), to = p.parameter(target);
    std::vector<Cut> cuts{{from, FrameSide::none}, {to, FrameSide::none}};
    const double half = p.h / 2;
    add_cuts(-p.uy / (2 * p.h), p.ux, p.focus.x + p.uy * half, frame_.least_x, FrameSide::least_x, cuts);
    add_cuts(-p.uy / (2 * p.h), p.ux, p.focus.x + p.uy * half, frame_.most_x, FrameSide::most_x, cuts);
    add_cuts(p.ux / (2 * p.h), p.uy, p.focus.y - p.ux * half, frame_.least_y, FrameSide::least_y, cuts);
    add_cuts(p.ux / (2 * p.h), p.uy, p.focus.y - p.ux * half, frame_.most_y, FrameSide::most_y, cuts);
    std::erase_if(cuts, [&](const Cut& c) {
      return c.side != FrameSide::none && (c.t <= std::min(from, to) || c.t >= std::max(from, to));
    });
    std::stable_sort(cuts.begin(), cuts.end(),
                     [&](const Cut& a, const Cut& b) { return from < to ? a.t < b.t : b.t < a.t; });
    for (std::size_t k = 0, next; k + 1 < cuts.size(); k = next) {
      next = k + 1;
      if (!is_inside_between(p, cuts[k], cuts[next])) continue;
      while (next + 1 < cuts.size() && is_inside_between(p, cuts[next], cuts[next + 1])) ++next;
      const auto node = [&](const Cut& cut) {
        if (cut.side == FrameSide::none) return cut.t == from ? arc.source : arc.target;
        return graph_.add_node({p.place(cut.t), p.radius(cut.t)}, cut.side);
      };
      const std::int32_t first = node(cuts[k]), last = node(cuts[next]);
      kept_.push_back({first, last, arc.left, arc.right, arc.group});
    }
  }

  bool is_inside_between(const Parabola& p, const Cut& a, const Cut& b) const {
    return a.t != b.t && frame_.holds(p.place((a.t + b.t) / 2));
  }

  // Roots of a t^2 + b t + c = value.
  static void add_cuts(double a, double b, double c, double value, FrameSide side, std::vector<Cut>& cuts) {
    const double constant = c - value, discriminant = b * b - 4 * a * constant;
    if (discriminant < 0) return;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
    if (q != 0) cuts.push_back({constant / q, side});
    if (a != 0) cuts.push_back({q / a, side});
  }

  SkeletonGraph& graph_;
  const Frame& frame_;
  std::vector<GraphArc>& kept_;
};

}  // namespace

void clip_to_frame(SkeletonGraph& graph, std::int32_t group, const Frame& frame,
                   const base::Monitor& monitor) {
  constexpr std::size_t often = 1 << 16;  // arcs between two looks at the monitor: some milliseconds
  std::vector<GraphArc> kept;
  kept.reserve(graph.arcs.size());
  Clipper clipper(graph, frame, kept);
  for (std::size_t k = 0; k < graph.arcs.size(); ++k) {
    if (k % often == 0) base::report(monitor, 0);
    if (group == every_group || graph.arcs[k].group == group) {
      clipper.clip(graph.arcs[k]);
    } else {
      kept.push_back(graph.arcs[k]);
    }
  }
  graph.arcs = std::move(kept);
}

}  // namespace vorotool::core::skeleton
