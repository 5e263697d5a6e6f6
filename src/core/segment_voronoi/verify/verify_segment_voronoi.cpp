#include "core/segment_voronoi/verify/verify_segment_voronoi.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/segment_voronoi/build/incident_segments.hpp"
#include "core/segment_voronoi/verify/combinatorial_map.hpp"
#include "core/segment_voronoi/verify/verify_edges.hpp"
#include "core/segment_voronoi/verify/verify_vertices.hpp"

namespace vorotool::core::segment_voronoi::verify {

using base::Fault;
using build::DiagramView;

namespace {

using Site = std::int32_t;

std::string text(const char* what, std::size_t number) { return what + std::to_string(number); }

bool in_range(Site value, std::size_t count) { return value >= 0 && static_cast<std::size_t>(value) < count; }

Fault check_sites(const DiagramView& in) {
  for (std::size_t i = 0; i < in.points.size(); ++i) {
    const auto& [x, y] = in.points[i];
    if (std::abs(std::int64_t{x}) > kernel::lattice_limit ||
        std::abs(std::int64_t{y}) > kernel::lattice_limit) {
      return text("a coordinate is beyond the lattice at point ", i);
    }
  }
  std::vector<std::size_t> order(in.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  auto key = [&](std::size_t i) { return std::pair(in.points[i].x, in.points[i].y); };
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return key(i) < key(j); });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (key(order[i]) == key(order[i - 1])) return text("another point is at the place of point ", order[i]);
  }
  for (std::size_t j = 0; j < in.segments.size(); ++j) {
    const auto& [a, b] = in.segments[j];
    if (!in_range(a, in.points.size()) || !in_range(b, in.points.size()) || a == b) {
      return text("an end is wrong of segment ", j);
    }
  }
  return {};
}

Fault check_ring(const DiagramView& in, std::size_t vertex) {
  const auto ring = in.ring(vertex);
  std::vector<Site> sorted(ring.begin(), ring.end());
  std::sort(sorted.begin(), sorted.end());
  if (sorted.size() < 3) return text("fewer than three sites are at vertex ", vertex);
  if (!in_range(sorted.front(), in.site_count()) || !in_range(sorted.back(), in.site_count())) {
    return text("a site is out of range at vertex ", vertex);
  }
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    return text("a site is twice at vertex ", vertex);
  }
  if (ring.front() != sorted.front()) return text("the smallest site is not the first at vertex ", vertex);
  const bool finite = std::isfinite(in.vertices[vertex].x) && std::isfinite(in.vertices[vertex].y) &&
                      std::isfinite(in.radius[vertex]);
  return finite ? Fault() : text("a value is not finite at vertex ", vertex);
}

Fault check_indices(const DiagramView& in, unsigned threads, const base::Monitor& monitor) {
  const auto& start = in.vertex_start;
  if (start.front() != 0 || static_cast<std::size_t>(start.back()) != in.vertex_sites.size()) {
    return "vertex_start does not span vertex_sites";
  }
  for (std::size_t v = 0; v + 1 < start.size(); ++v) {
    if (start[v + 1] < start[v]) return text("vertex_start decreases after vertex ", v);
  }
  auto check = [&](std::size_t v) { return check_ring(in, v); };
  if (Fault fault = base::first_fault(in.vertex_count(), check, threads, monitor)) return fault;
  for (std::size_t k = 0; k < in.edges.size(); ++k) {
    for (const Site v : in.edges[k]) {
      if (v != -1 && !in_range(v, in.vertex_count())) return text("a vertex is out of range of edge ", k);
    }
    const auto& [left, right] = in.edge_sites[k];
    if (!in_range(left, in.site_count()) || !in_range(right, in.site_count()) || left == right) {
      return text("a site is wrong of edge ", k);
    }
  }
  return {};
}

// No two vertices have one ring: with rings that are right, that makes the vertices distinct.
Fault check_distinct(const DiagramView& in) {
  std::vector<std::size_t> order(in.vertex_count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  auto less = [&](std::size_t v, std::size_t w) {
    return std::ranges::lexicographical_compare(in.ring(v), in.ring(w));
  };
  std::sort(order.begin(), order.end(), less);
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (!less(order[i - 1], order[i])) return text("another vertex has all the sites of vertex ", order[i]);
  }
  return {};
}

}  // namespace

// Why the checks suffice. Each vertex given is a vertex of the true diagram, with its true ring, and no two
// are the same; both maps have the same cells, each one cycle of edges, and the same ring at infinity; both
// are connected and meet Euler's relation. So in both, with F cells,
//   sum over the vertices of (degree - 2) + degree of infinity = 2 E - 2 V = 2 F - 2,
// and every vertex adds at least 1: none is missing. Then along each bisector the places where edges leave
// and where they arrive are the true ones, and the edges that follow each other without overlap join them as
// the true ones do. The points inside edges are looked at in spite of that.
Fault find_fault(const DiagramView& arrays, unsigned threads, const base::Monitor& monitor) {
  if (Fault fault = check_sites(arrays)) return fault;
  if (Fault fault = check_indices(arrays, threads, monitor)) return fault;
  if (Fault fault = check_distinct(arrays)) return fault;
  const build::IncidentSegments incident(arrays);
  if (Fault fault = find_map_fault(arrays, incident)) return fault;
  const ClosedSites index(arrays, incident, threads, monitor);
  auto check = [&](std::size_t v) { return find_vertex_fault(arrays, incident, index, v); };
  if (Fault fault = base::first_fault(arrays.vertex_count(), check, threads, monitor)) return fault;
  if (Fault fault = find_order_fault(arrays, incident)) return fault;
  return find_inner_point_fault(arrays, index, threads, monitor);
}

}  // namespace vorotool::core::segment_voronoi::verify
