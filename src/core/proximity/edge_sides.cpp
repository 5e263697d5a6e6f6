#include "core/proximity/edge_sides.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "core/base/groups.hpp"
#include "core/base/indices.hpp"
#include "core/delaunay/half_edge.hpp"
#include "core/delaunay/vertex_triangles.hpp"

namespace vorotool::core::proximity {

using base::at;

namespace {

// An edge by its larger end, among those of one smaller end.
using Partner = std::pair<std::int32_t, std::int32_t>;

base::Groups<Partner> edges_by_end(const delaunay::TriangulationArrays& mesh) {
  base::Groups<Partner> partners(mesh.points.size(), [&](const auto& add) {
    for (std::size_t e = 0; 2 * e < mesh.edges.size(); ++e) {
      const auto [a, b] = std::minmax(mesh.edges[2 * e], mesh.edges[2 * e + 1]);
      add(a, Partner{b, static_cast<std::int32_t>(e)});
    }
  });
  for (std::size_t v = 0; v < partners.size(); ++v) {
    const std::span<Partner> group = partners[v];
    std::sort(group.begin(), group.end());
  }
  return partners;
}

}  // namespace

std::vector<std::int32_t> edge_sides(const delaunay::TriangulationArrays& mesh) {
  delaunay::check_indices(mesh);
  const base::Groups<Partner> partners = edges_by_end(mesh);
  std::vector<std::int32_t> sides(mesh.edges.size() / 2, -1);
  for (std::size_t h = 0; h < mesh.triangles.size(); ++h) {
    const std::int32_t across = mesh.neighbors[h];
    if (across >= 0 && at(across) < h / 3) continue;
    const auto [a, b] =
        std::minmax(mesh.triangles[delaunay::following(h)], mesh.triangles[delaunay::preceding(h)]);
    const std::span<const Partner> group = partners[a];
    const auto found = std::lower_bound(group.begin(), group.end(), Partner{b, 0});
    if (found == group.end() || found->first != b)
      throw std::invalid_argument("a side of a triangle is no edge");
    sides[at(found->second)] = static_cast<std::int32_t>(h);
  }
  return sides;
}

}  // namespace vorotool::core::proximity
