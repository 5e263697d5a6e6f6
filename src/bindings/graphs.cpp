// Paths in graphs of arcs, and colors of graphs.
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/base/indices.hpp"
#include "core/graphs/boundary_cycles.hpp"
#include "core/graphs/connected_components.hpp"
#include "core/graphs/graph_coloring.hpp"
#include "core/graphs/longest_paths.hpp"
#include "core/graphs/planar_map.hpp"

namespace vorotool::bindings {
namespace {

using core::base::IndexPair;
using core::base::Monitor;
using core::graphs::GraphPath;

std::span<const IndexPair> checked(const IndexRows& arcs, const Vector<const double>& length,
                                   std::size_t nodes) {
  const std::span<const IndexPair> pairs = rows<IndexPair>(arcs);
  if (pairs.size() != length.size()) throw std::invalid_argument("each arc must have a length");
  core::base::check_range(pairs, 0, nodes, "a node is out of range");
  return pairs;
}

auto longest_paths(const IndexRows& arcs, const Vector<const double>& length, const Indices& group,
                   std::size_t groups, std::size_t nodes, double tie, const Progress& progress) {
  const std::span<const IndexPair> pairs = checked(arcs, length, nodes);
  if (group.size() != pairs.size()) throw std::invalid_argument("each arc must have a group");
  core::base::check_range(view(group), 0, groups, "a group is out of range");
  std::vector<GraphPath> paths = run_interruptible(progress, [&](const Monitor& monitor) {
    const std::vector<std::int64_t> whole = core::graphs::whole_lengths(view(length), view(group), groups);
    return core::graphs::longest_paths(pairs, whole, view(group), groups, nodes, tie, monitor);
  });
  std::vector<std::int64_t> start{0};
  std::vector<std::int32_t> path_arcs, path_nodes;
  for (const GraphPath& path : paths) {
    path_arcs.insert(path_arcs.end(), path.arcs.begin(), path.arcs.end());
    if (!path.nodes.empty()) path_nodes.insert(path_nodes.end(), path.nodes.begin() + 1, path.nodes.end());
    start.push_back(static_cast<std::int64_t>(path_arcs.size()));
  }
  return std::make_tuple(to_numpy(std::move(start)), to_numpy(std::move(path_arcs)),
                         to_numpy(std::move(path_nodes)));
}

auto path_from(const IndexRows& arcs, const Vector<const double>& length, std::size_t nodes,
               std::int32_t first, std::int32_t last, const Progress& progress) {
  const std::span<const IndexPair> pairs = checked(arcs, length, nodes);
  if (first < 0 || static_cast<std::size_t>(first) >= nodes ||
      (last >= 0 && static_cast<std::size_t>(last) >= nodes)) {
    throw std::invalid_argument("a node is out of range");
  }
  GraphPath path = run_interruptible(progress, [&](const Monitor& monitor) {
    const std::vector<std::int32_t> group(pairs.size());
    return core::graphs::path_from(pairs, core::graphs::whole_lengths(view(length), group, 1), nodes, first,
                                   last, monitor);
  });
  std::optional<std::tuple<Array<std::int32_t>, Array<std::int32_t>>> found;
  if (path.nodes.empty()) return found;
  path.nodes.erase(path.nodes.begin());
  found.emplace(to_numpy(std::move(path.arcs)), to_numpy(std::move(path.nodes)));
  return found;
}

auto color_graph(std::size_t vertices, Vector<const std::uint32_t> a, Vector<const std::uint32_t> b,
                 const Progress& progress) {
  std::vector<core::graphs::Edge> edges(a.size());
  for (std::size_t k = 0; k < edges.size(); ++k) edges[k] = {a.data()[k], b.data()[k]};
  return to_numpy(run_interruptible(progress, core::graphs::color_graph, vertices, edges));
}

auto connected_components(const IndexRows& edges, std::size_t vertices) {
  const std::span<const IndexPair> pairs = rows<IndexPair>(edges);
  core::base::check_range(pairs, 0, vertices, "a vertex is out of range");
  return to_numpy(core::graphs::connected_components(pairs, vertices));
}

auto arcs_by_ends(const IndexRows& arcs, std::size_t vertices) {
  const std::span<const IndexPair> pairs = rows<IndexPair>(arcs);
  core::base::check_range(pairs, 0, vertices, "a vertex is out of range");
  return to_numpy(core::graphs::arcs_by_ends(pairs, vertices));
}

auto next_half_edges(const IndexRows& arcs, const Matrix<const std::int64_t>& order, std::size_t vertices) {
  const std::span<const IndexPair> pairs = rows<IndexPair>(arcs);
  if (order.size() != 2 * pairs.size())
    throw std::invalid_argument("each arc must have two numbers of its order");
  core::base::check_range(pairs, 0, vertices, "a vertex is out of range");
  return to_numpy(core::graphs::next_half_edges(pairs, view(order), vertices));
}

auto boundary_cycles(const Indices& next, const Indices& tail, std::size_t vertices) {
  if (next.size() != tail.size()) throw std::invalid_argument("each half-edge must have a tail");
  core::base::check_range(view(next), 0, next.size(), "a half-edge is out of range");
  core::base::check_range(view(tail), 0, vertices, "a vertex is out of range");
  core::graphs::BoundaryCycles cycles = core::graphs::boundary_cycles(view(next), view(tail), vertices);
  return std::make_tuple(to_numpy(std::move(cycles.start)), to_numpy(std::move(cycles.half_edge)));
}

}  // namespace

void bind_graphs(nb::module_& room) {
  room.def("longest_paths", &longest_paths, "arcs"_a, "length"_a, "group"_a, "groups"_a, "nodes"_a, "tie"_a,
           "progress"_a.none(),
           "Where the arcs of each group's path begin, the arcs, and the node that each leads to.");
  room.def("path_from", &path_from, "arcs"_a, "length"_a, "nodes"_a, "first"_a, "last"_a, "progress"_a.none(),
           "Arcs of the shortest path, and the node that each leads to; with last -1 to the farthest leaf.");
  room.def("color_graph", &color_graph, "vertices"_a, "a"_a, "b"_a, "progress"_a.none());
  room.def("connected_components", &connected_components, "edges"_a, "vertices"_a,
           "The smallest vertex that each is connected with.");
  room.def("arcs_by_ends", &arcs_by_ends, "arcs"_a, "vertices"_a,
           "The arcs by their sources, then by their targets; those between the same two as they are given.");
  room.def("next_half_edges", &next_half_edges, "arcs"_a, "order"_a, "vertices"_a,
           "The half-edge after each one around its face: 2 k along arc k, 2 k + 1 back.");
  room.def("boundary_cycles", &boundary_cycles, "next"_a, "tail"_a, "vertices"_a,
           "Where the cycles begin that pass no vertex twice, and the half-edges along them.");
}

}  // namespace vorotool::bindings
