#include "core/proximity/proximity_graphs.hpp"

#include <cstddef>
#include <span>

#include "core/alpha/critical_radius.hpp"
#include "core/alpha/radius_ranks.hpp"
#include "core/base/disjoint_sets.hpp"
#include "core/base/groups.hpp"
#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/delaunay/half_edge.hpp"
#include "core/kernel/circumcenter.hpp"
#include "core/proximity/edge_sides.hpp"
#include "core/proximity/empty_lunes.hpp"

namespace vorotool::core::proximity {

using base::at;
using base::Monitor;
using delaunay::TriangulationArrays;
using kernel::Point;

namespace {

constexpr std::size_t edges_a_piece = std::size_t{1} << 13;  // edges: some milliseconds of work

using Kept = std::vector<std::uint8_t>;  // [e] whether each edge is in the graph

// Of the points only the two opposite to the edge can be in the disc first: on one side of an edge circles
// through its ends are nested, and that of the triangle is empty.
bool is_gabriel(const TriangulationArrays& mesh, std::int32_t side) {
  const auto h = static_cast<std::size_t>(side);
  const auto point = [&](std::size_t i) -> const Point& { return mesh.points[at(mesh.triangles[i])]; };
  const Point &a = point(delaunay::following(h)), &b = point(delaunay::preceding(h));
  if (kernel::angle_sign(point(h), a, b) <= 0) return false;
  const std::int32_t across = mesh.neighbors[h];
  if (across < 0) return true;
  for (std::size_t k = 3 * at(across); k < 3 * at(across) + 3; ++k) {
    const std::int32_t v = mesh.triangles[k];
    const bool is_end =
        v == mesh.triangles[delaunay::following(h)] || v == mesh.triangles[delaunay::preceding(h)];
    if (!is_end && kernel::angle_sign(mesh.points[at(v)], a, b) <= 0) return false;
  }
  return true;
}

// Where there are no triangles the points are collinear: all edges are in all graphs.
Kept edges_by_rule(const TriangulationArrays& mesh, ProximityKind kind, unsigned threads,
                   const Monitor& monitor) {
  const std::vector<std::int32_t> sides = edge_sides(mesh);
  const double scale = scale_of(mesh.points);
  Kept kept(sides.size());
  base::for_pieces(
      sides.size(), edges_a_piece, threads, monitor, [&](std::size_t, std::size_t first, std::size_t end) {
        EmptyLunes lunes(mesh, scale);
        for (std::size_t e = first; e < end; ++e) {
          const bool is_in = sides[e] < 0 || (kind == ProximityKind::gabriel ? is_gabriel(mesh, sides[e])
                                                                             : lunes.is_empty(sides[e]));
          kept[e] = is_in ? 1 : 0;
        }
      });
  return kept;
}

std::vector<std::int32_t> places_of(const Kept& kept) {
  std::vector<std::int32_t> places;
  for (std::size_t e = 0; e < kept.size(); ++e) {
    if (kept[e] != 0) places.push_back(static_cast<std::int32_t>(e));
  }
  return places;
}

// Kruskal's algorithm. An edge with a point in its lune is the longest of a cycle, so that edges of relative
// neighbors suffice.
Kept spanning_tree(const TriangulationArrays& mesh, std::span<const std::int32_t> edges, unsigned threads,
                   const Monitor& monitor) {
  const auto support_of = [&](std::size_t i) {
    const Point& a = mesh.points[at(mesh.edges[2 * at(edges[i])])];
    return alpha::Support{a, mesh.points[at(mesh.edges[2 * at(edges[i]) + 1])], a, false};
  };
  base::LargeArray<double> half_length(edges.size());
  base::for_items(edges.size(), edges_a_piece, threads, monitor,
                  [&](std::size_t i) { half_length[i] = alpha::critical_radius(support_of(i)); });
  const auto compare = [&support_of](std::uint32_t q) {
    return [&support_of, q](std::uint32_t p) { return alpha::compare_radii(support_of(p), support_of(q)); };
  };
  const alpha::RadiusRanks ranks =
      alpha::rank_radii({half_length.data(), half_length.size()}, compare, threads, monitor);
  const base::Groups<std::uint32_t> by_length(ranks.value.size(), [&](const auto& add) {
    for (std::size_t i = 0; i < edges.size(); ++i) add(ranks.rank[i], static_cast<std::uint32_t>(i));
  });
  Kept kept(mesh.edges.size() / 2);
  base::DisjointSets<std::int32_t> parts(mesh.points.size());
  for (std::size_t rank = 0; rank < by_length.size(); ++rank) {
    base::report_item(monitor, rank, by_length.size());
    for (const std::uint32_t i : by_length[rank]) {
      const std::size_t e = at(edges[i]);
      kept[e] = parts.join(mesh.edges[2 * e], mesh.edges[2 * e + 1]) ? 1 : 0;
    }
  }
  return kept;
}

}  // namespace

std::vector<std::int32_t> proximity_edges(const TriangulationArrays& mesh, ProximityKind kind,
                                          unsigned threads, const Monitor& monitor) {
  std::vector<std::int32_t> found = places_of(edges_by_rule(mesh, kind, threads, monitor));
  if (kind != ProximityKind::spanning_tree) return found;
  return places_of(spanning_tree(mesh, found, threads, monitor));
}

}  // namespace vorotool::core::proximity
