#include "core/voronoi/ring_areas.hpp"

#include <cstddef>

namespace vorotool::core::voronoi {

using base::at;
using kernel::Point;

std::vector<double> ring_areas(std::span<const std::int64_t> start, std::span<const std::int64_t> half_edge,
                               std::span<const base::IndexPair> ends, std::span<const Point> places,
                               std::span<const double> bulge) {
  std::vector<double> areas;
  for (std::size_t r = 0; r + 1 < start.size(); ++r) {
    const auto begin = static_cast<std::size_t>(start[r]), end = static_cast<std::size_t>(start[r + 1]);
    double area = 0;
    Point first{};
    for (std::size_t k = begin; k < end; ++k) {
      const auto h = static_cast<std::size_t>(half_edge[k]);
      const auto& [source, target] = ends[h / 2];
      if (k == begin) first = places[at(h % 2 == 0 ? source : target)];
      const double beside = cross(places[at(source)] - first, places[at(target)] - first) / 2 + bulge[h / 2];
      area += h % 2 == 0 ? beside : -beside;
    }
    areas.push_back(area);
  }
  return areas;
}

}  // namespace vorotool::core::voronoi
