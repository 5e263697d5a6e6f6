#include "core/arrangement/verify_planar_graph.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <set>
#include <vector>

#include "core/base/indices.hpp"

namespace vorotool::core::arrangement {

using base::Monitor;
using kernel::LatticePoint;
using kernel::PlanarGraphView;

namespace {

using base::Fault;

std::string named(LatticePoint p) {
  return std::string("(").append(std::to_string(p.x)).append(", ").append(std::to_string(p.y)).append(")");
}

// Sweeps a horizontal line upwards and keeps the segments that it cuts from left to right (Shamos and Hoey
// 1976): if there is a fault, then two segments are neighbors below the lowest one.
class CheckingSweep {
 public:
  CheckingSweep(const PlanarGraphView& graph, const Monitor& monitor)
      : graph_(graph), monitor_(monitor), cut_(IsLeft{this}), place_(graph.segments.size()) {}

  Fault run() {
    const std::vector<std::size_t> order = sorted_points();
    for (std::size_t i = 1; i < order.size(); ++i) {
      if (graph_.points[order[i]] == graph_.points[order[i - 1]]) {
        return "points " + std::to_string(std::min(order[i], order[i - 1])) + " and " +
               std::to_string(std::max(order[i], order[i - 1])) + " are both at " +
               named(graph_.points[order[i]]);
      }
    }
    incident_.resize(graph_.points.size());
    for (std::size_t s = 0; s < place_.size(); ++s) {
      for (const std::int32_t end : graph_.segments[s]) incident_[base::at(end)].push_back(s);
    }
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (Fault fault = pass(order[i])) return fault;
      if (i % 1024 == 0) base::report(monitor_, static_cast<double>(i) / static_cast<double>(order.size()));
    }
    return {};
  }

 private:
  // Left to right where both are cut: told where the higher one begins, or above where both do.
  struct IsLeft {
    using is_transparent = void;
    const CheckingSweep* sweep;

    bool operator()(std::size_t s, std::size_t t) const {
      if (s == t) return false;
      const LatticePoint a = sweep->lower(s), b = sweep->lower(t);
      if (a == b) return sweep->side(t, sweep->upper(s)) < 0;
      return is_lower(a, b) ? sweep->side(s, b) > 0 : sweep->side(t, a) < 0;
    }
    bool operator()(std::size_t s, LatticePoint p) const { return sweep->side(s, p) > 0; }
    bool operator()(LatticePoint p, std::size_t s) const { return sweep->side(s, p) < 0; }
  };
  using Cut = std::set<std::size_t, IsLeft>;

  static bool is_lower(LatticePoint a, LatticePoint b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }

  LatticePoint end(std::size_t s, std::size_t k) const { return graph_.point(graph_.segments[s][k]); }
  LatticePoint lower(std::size_t s) const { return std::min(end(s, 0), end(s, 1), is_lower); }
  LatticePoint upper(std::size_t s) const { return std::max(end(s, 0), end(s, 1), is_lower); }

  // 1 if p is right of the segment seen upwards, -1 left of it, 0 on its line: see lattice_limit.
  int side(std::size_t s, LatticePoint p) const {
    const LatticePoint a = lower(s), b = upper(s);
    const std::int64_t area = (std::int64_t{b.y} - a.y) * (std::int64_t{p.x} - a.x) -
                              (std::int64_t{b.x} - a.x) * (std::int64_t{p.y} - a.y);
    return (area > 0) - (area < 0);
  }

  std::vector<std::size_t> sorted_points() const {
    std::vector<std::size_t> order(graph_.points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [this](std::size_t i, std::size_t j) { return is_lower(graph_.points[i], graph_.points[j]); });
    return order;
  }

  Fault pass(std::size_t point) {
    const LatticePoint p = graph_.points[point];
    for (const std::size_t s : incident_[point]) {
      if (!(upper(s) == p)) continue;
      const auto next = cut_.erase(place_[s]);
      if (next == cut_.end() || next == cut_.begin()) continue;
      if (Fault fault = fault_of(*std::prev(next), *next)) return fault;
    }
    // all segments that end here are gone: none of the others may pass through
    if (const auto found = cut_.find(p); found != cut_.end()) {
      return "point " + std::to_string(point) + " at " + named(p) + " lies inside segment " +
             std::to_string(*found);
    }
    for (const std::size_t s : incident_[point]) {
      if (!(lower(s) == p)) continue;
      const auto [at, is_new] = cut_.insert(s);
      if (!is_new) return "segments " + std::to_string(*at) + " and " + std::to_string(s) + " overlap";
      place_[s] = at;
      if (at != cut_.begin()) {
        if (Fault fault = fault_of(*std::prev(at), s)) return fault;
      }
      if (std::next(at) != cut_.end()) {
        if (Fault fault = fault_of(s, *std::next(at))) return fault;
      }
    }
    return {};
  }

  // Whether two segments have a point in common that is no common end.
  Fault fault_of(std::size_t s, std::size_t t) const {
    const LatticePoint a = lower(s), b = upper(s), c = lower(t), d = upper(t);
    const int sc = side(s, c), sd = side(s, d), ta = side(t, a), tb = side(t, b);
    const bool cross = sc * sd < 0 && ta * tb < 0;
    const bool touch = (sc == 0 && is_inside(a, b, c)) || (sd == 0 && is_inside(a, b, d)) ||
                       (ta == 0 && is_inside(c, d, a)) || (tb == 0 && is_inside(c, d, b));
    const bool same = a == c && b == d;
    if (!cross && !touch && !same) return {};
    return "segments " + std::to_string(std::min(s, t)) + " and " + std::to_string(std::max(s, t)) +
           (cross   ? " cross"
            : touch ? " touch"
                    : " have the same ends") +
           " near " + named(touch || same ? a : c);
  }

  // For a point on the line through a and b.
  static bool is_inside(LatticePoint a, LatticePoint b, LatticePoint p) {
    return is_lower(a, p) && is_lower(p, b);
  }

  const PlanarGraphView& graph_;
  const Monitor& monitor_;
  Cut cut_;
  std::vector<Cut::iterator> place_;
  std::vector<std::vector<std::size_t>> incident_;
};

Fault index_fault(const PlanarGraphView& graph) {
  for (std::size_t i = 0; i < graph.points.size(); ++i) {
    const LatticePoint p = graph.points[i];
    if (std::max({p.x, p.y}) > kernel::lattice_limit || std::min({p.x, p.y}) < -kernel::lattice_limit) {
      return "point " + std::to_string(i) + " at " + named(p) + " is beyond the lattice";
    }
  }
  const auto points = static_cast<std::int32_t>(graph.points.size());
  for (std::size_t s = 0; s < graph.segments.size(); ++s) {
    const auto [a, b] = graph.segments[s];
    if (std::min(a, b) < 0 || std::max(a, b) >= points) {
      return "segment " + std::to_string(s) + " ends at a point that does not exist";
    }
    if (a == b) return "segment " + std::to_string(s) + " has no length";
  }
  return {};
}

// The faces on both sides of every corner: segments around a point in the order of their angle.
Fault corner_fault(const PlanarGraphView& graph) {
  struct Spoke {
    std::int64_t x, y;
    std::int32_t left, right;  // faces, seen from the point

    bool is_upper() const { return y > 0 || (y == 0 && x > 0); }
    bool operator<(const Spoke& other) const {
      if (is_upper() != other.is_upper()) return is_upper();
      return x * other.y - y * other.x > 0;
    }
  };
  std::vector<std::vector<Spoke>> spokes(graph.points.size());
  for (std::size_t s = 0; s < graph.segments.size(); ++s) {
    for (const std::size_t back : {std::size_t{0}, std::size_t{1}}) {
      const std::int32_t from = graph.segments[s][back], to = graph.segments[s][1 - back];
      const LatticePoint a = graph.point(from), b = graph.point(to);
      spokes[base::at(from)].push_back(
          {std::int64_t{b.x} - a.x, std::int64_t{b.y} - a.y, graph.faces[s][back], graph.faces[s][1 - back]});
    }
  }
  for (std::size_t i = 0; i < spokes.size(); ++i) {
    std::sort(spokes[i].begin(), spokes[i].end());
    for (std::size_t k = 0; k < spokes[i].size(); ++k) {
      if (spokes[i][k].left == spokes[i][(k + 1) % spokes[i].size()].right) continue;
      return "around point " + std::to_string(i) + " at " + named(graph.points[i]) +
             " one corner has two faces";
    }
  }
  return {};
}

}  // namespace

Fault find_fault(const PlanarGraphView& graph, const Monitor& monitor) {
  if (Fault fault = index_fault(graph)) return fault;
  if (Fault fault = CheckingSweep(graph, monitor).run()) return fault;
  return graph.faces.empty() ? Fault{} : corner_fault(graph);
}

}  // namespace vorotool::core::arrangement
