#include "core/delaunay/nearest_neighbors.hpp"

#include <cstddef>
#include <stdexcept>

#include "core/kernel/circumcenter.hpp"

namespace vorotool::core::delaunay {

NearestNeighbors nearest_neighbors(std::span<const kernel::Point> points, std::span<const std::int32_t> edges,
                                   std::span<const std::int64_t> labels, const base::Monitor& monitor) {
  NearestNeighbors result{std::vector<std::int32_t>(points.size(), -1),
                          std::vector<std::int32_t>(points.size(), 0)};
  const auto meet = [&](std::size_t p, std::size_t q) {
    ++result.count[p];
    std::int32_t& best = result.nearest[p];
    if (best >= 0) {
      const auto b = static_cast<std::size_t>(best);
      const int order = kernel::compare_distances(points[p], points[q], points[b]);
      if (order > 0 || (order == 0 && labels[q] > labels[b])) return;
    }
    best = static_cast<std::int32_t>(q);
  };
  for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {
    base::report_item(monitor, i, edges.size());
    const auto a = static_cast<std::size_t>(edges[i]), b = static_cast<std::size_t>(edges[i + 1]);
    if (a >= points.size() || b >= points.size())
      throw std::invalid_argument("an edge names a point that does not exist");
    meet(a, b);
    meet(b, a);
  }
  return result;
}

}  // namespace vorotool::core::delaunay
