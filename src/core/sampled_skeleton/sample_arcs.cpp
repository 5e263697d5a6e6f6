#include "core/sampled_skeleton/sample_arcs.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/kernel/circumcenter.hpp"
#include "core/numbers/special_values.hpp"

namespace vorotool::core::sampled_skeleton {

using base::at;
using kernel::Point;
using numbers::infinity;
using skeleton::FrameSide;
using skeleton::GraphArc;
using skeleton::Line;

namespace {}  // namespace

// A node that a line to a corner makes inside an arc.
struct SampleArcs::Division {
  std::size_t arc;
  double along;  // from the source of the arc
  std::int32_t node;
};

void SampleArcs::add_kept(std::span<const std::int32_t> face_group) {
  const SampleMesh& mesh = diagram_.mesh();
  node_of_.assign(mesh.size(), -1);
  std::size_t count = 0;
  for (std::size_t s = 0; s < mesh.sides(); ++s) count += is_wanted(static_cast<Side>(s), face_group) ? 1 : 0;
  arcs_.reserve(count);
  origin_.reserve(count);
  for (std::size_t i = 0; i < mesh.sides(); ++i) {
    const auto s = static_cast<Side>(i);
    if (is_wanted(s, face_group)) add_side(s, face_group[at(diagram_.face(SampleMesh::triangle_of(s)))]);
  }
  const auto chain = diagram_.chain();
  for (std::size_t i = 1; i < chain.size() && face_group[0] >= 0; ++i) {
    if (!diagram_.labels().share(chain[i - 1], chain[i]))
      add_chain_link(chain[i - 1], chain[i], face_group[0]);
  }
}

bool SampleArcs::is_wanted(Side s, std::span<const std::int32_t> face_group) const {
  if (!diagram_.is_kept(s) || !diagram_.mesh().is_first(s)) return false;
  const std::int32_t face = diagram_.face(SampleMesh::triangle_of(s));
  return face >= 0 && face_group[at(face)] >= 0;
}

void SampleArcs::add_all() {
  node_of_.assign(diagram_.mesh().size(), -1);
  for (std::size_t i = 0; i < diagram_.mesh().sides(); ++i) {
    if (diagram_.mesh().is_first(static_cast<Side>(i))) add_side(static_cast<Side>(i), 0);
  }
  const auto chain = diagram_.chain();
  for (std::size_t i = 1; i < chain.size(); ++i) add_chain_link(chain[i - 1], chain[i], 0);
}

// The Voronoi edge leads across the side from its left to its right: the target of the side is on the left.
// Between triangles with one circumcenter it has no length.
void SampleArcs::add_side(Side s, std::int32_t group) {
  const Triangle t = diagram_.same_center(SampleMesh::triangle_of(s)), across = diagram_.mesh().across(s);
  if (across >= 0 && diagram_.same_center(across) == t) return;
  const std::int32_t source = node_of(t);
  add_arc({source, across < 0 ? -1 : node_of(diagram_.same_center(across)), diagram_.mesh().target(s),
           diagram_.mesh().origin(s), group},
          {s, -1});
}

void SampleArcs::add_chain_link(std::int32_t p, std::int32_t q, std::int32_t group) {
  add_arc({-1, -1, q, p, group}, {-1, -1});
}

std::int32_t SampleArcs::node_of(Triangle t) {
  std::int32_t& node = node_of_[at(t)];
  if (node < 0) {
    node = static_cast<std::int32_t>(node_triangle_.size());
    node_triangle_.push_back(t);
  }
  return node;
}

std::int32_t SampleArcs::add_node(const Point& place, FrameSide side) {
  place_.push_back(place);
  side_.push_back(side);
  return static_cast<std::int32_t>(place_.size()) - 1;
}

void SampleArcs::add_arc(const GraphArc& arc, const ArcOrigin& origin) {
  arcs_.push_back(arc);
  origin_.push_back(origin);
}

void SampleArcs::place_nodes(unsigned threads, const base::Monitor& monitor) {
  constexpr std::size_t grain = 1 << 13;
  place_.resize(node_triangle_.size());
  side_.assign(node_triangle_.size(), FrameSide::none);
  const SampleMesh& mesh = diagram_.mesh();
  base::for_items(place_.size(), grain, threads, monitor, [&](std::size_t i) {
    const Triangle t = node_triangle_[i];
    const kernel::RoundedPoint center = kernel::circumcenter(
        mesh.seed(mesh.apex(3 * t)), mesh.seed(mesh.apex(3 * t + 1)), mesh.seed(mesh.apex(3 * t + 2)));
    place_[i] = {center.x.value, center.y.value};
  });
}

std::size_t SampleArcs::add_lines(std::span<const CornerBisector> lines,
                                  std::span<const std::int32_t> face_group,
                                  const skeleton::JoinedGroups& joined) {
  std::vector<Division> divisions;
  std::size_t open = 0;
  for (const CornerBisector& line : lines) {
    const kernel::LatticePoint& p = diagram_.labels().graph().point(line.corner);
    const Point corner{static_cast<double>(p.x), static_cast<double>(p.y)};
    std::int32_t target = -1;
    if (line.node >= 0) {
      target = node_of_[at(diagram_.same_center(line.node))];
    } else if (const std::optional<std::size_t> arc = arc_of(line.side)) {
      target = add_node({corner.x + line.along * line.direction.x, corner.y + line.along * line.direction.y},
                        FrameSide::none);
      divisions.push_back({*arc, norm(place(target) - place(arcs_[*arc].source)), target});
    }
    if (target < 0) {
      ++open;
      continue;
    }
    const std::int32_t group = face_group[at(line.face)];
    std::optional<std::int32_t> source;
    if (joined.contain(group)) source = node_at_corner(line.corner, group);
    if (!source) source = add_node(corner, FrameSide::none);
    add_arc({*source, target, line.left, line.right, group},
            {line.node >= 0 ? 3 * line.node : line.side, line.corner});
  }
  divide(divisions);
  return open;
}

// Of the lines from a corner, which are the last arcs.
std::optional<std::int32_t> SampleArcs::node_at_corner(std::int32_t corner, std::int32_t group) const {
  for (std::size_t arc = arcs_.size(); arc > 0 && origin_[arc - 1].corner == corner; --arc) {
    if (arcs_[arc - 1].group == group) return arcs_[arc - 1].source;
  }
  return {};
}

// Arcs were added in the order of the first sides of edges.
std::optional<std::size_t> SampleArcs::arc_of(Side s) const {
  const SampleMesh& mesh = diagram_.mesh();
  const Side first = mesh.is_first(s) ? s : mesh.twin(s);
  const auto end =
      std::find_if(origin_.begin(), origin_.end(), [](const ArcOrigin& o) { return o.corner >= 0; });
  const auto found = std::lower_bound(origin_.begin(), end, first,
                                      [](const ArcOrigin& origin, Side side) { return origin.side < side; });
  if (found == end || found->side != first) return {};
  return static_cast<std::size_t>(found - origin_.begin());
}

// The arc itself becomes its first part.
void SampleArcs::divide(std::vector<Division>& divisions) {
  std::sort(divisions.begin(), divisions.end(), [](const Division& a, const Division& b) {
    return a.arc != b.arc ? a.arc < b.arc : a.along < b.along;
  });
  for (std::size_t i = 0; i < divisions.size();) {
    const std::size_t arc = divisions[i].arc;
    GraphArc part = arcs_[arc];
    const std::int32_t target = part.target;
    arcs_[arc].target = divisions[i].node;
    for (; i < divisions.size() && divisions[i].arc == arc; ++i) {
      const bool is_last = i + 1 == divisions.size() || divisions[i + 1].arc != arc;
      part.source = divisions[i].node;
      part.target = is_last ? target : divisions[i + 1].node;
      add_arc(part, origin_[arc]);
    }
  }
}

void SampleArcs::clip(std::int32_t group, const skeleton::Frame& frame) {
  std::vector<GraphArc> arcs;
  std::vector<ArcOrigin> origins;
  arcs.swap(arcs_);
  origins.swap(origin_);
  for (std::size_t k = 0; k < arcs.size(); ++k) {
    const GraphArc& arc = arcs[k];
    const bool is_bounded = arc.source >= 0 && arc.target >= 0;
    if (arc.group != group ||
        (is_bounded && frame.holds(place(arc.source)) && frame.holds(place(arc.target)))) {
      add_arc(arc, origins[k]);
      continue;
    }
    const Line line = line_of(arc);
    const auto cuts = skeleton::cut_line(line, frame);
    if (!cuts) continue;
    const auto node = [&](const skeleton::Cut& cut, std::int32_t own) {
      return cut.side == FrameSide::none ? own : add_node(line.place(cut.t), cut.side);
    };
    const std::int32_t first = node(cuts->first, arc.source), last = node(cuts->second, arc.target);
    add_arc({first, last, arc.left, arc.right, arc.group}, origins[k]);
  }
}

// From the nearer end, which is rounded less; an unbounded one from between its seeds, the left one to the
// left.
Line SampleArcs::line_of(const GraphArc& arc) const {
  if (arc.source >= 0 && arc.target >= 0) {
    const Point &a = place(arc.source), &b = place(arc.target);
    const Point way{b.x - a.x, b.y - a.y};
    const auto size = [](const Point& p) { return std::max(std::abs(p.x), std::abs(p.y)); };
    return size(a) <= size(b) ? Line{a, way, 0, 1} : Line{b, way, -1, 0};
  }
  const kernel::Point &left = diagram_.mesh().seed(arc.left), &right = diagram_.mesh().seed(arc.right);
  const Point way{left.y - right.y, right.x - left.x};
  const Point middle{(left.x + right.x) / 2, (left.y + right.y) / 2};
  double from = -infinity;
  if (arc.source >= 0) {
    const Point& end = place(arc.source);
    from = ((end.x - middle.x) * way.x + (end.y - middle.y) * way.y) / (way.x * way.x + way.y * way.y);
  }
  return {middle, way, from, infinity};
}

}  // namespace vorotool::core::sampled_skeleton
