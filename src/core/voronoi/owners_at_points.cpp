#include "core/voronoi/owners_at_points.hpp"

#include <algorithm>
#include <limits>

namespace vorotool::core::voronoi {

using base::at;

OwnersAtPoints owners_at_points(std::span<const base::IndexPair> segments,
                                std::span<const std::int32_t> owner, std::size_t points) {
  OwnersAtPoints made{std::vector<std::int32_t>(points, std::numeric_limits<std::int32_t>::max()),
                      std::vector<std::int32_t>(points, -1)};
  for (std::size_t j = 0; j < segments.size(); ++j) {
    for (const std::int32_t point : segments[j]) {
      made.least[at(point)] = std::min(made.least[at(point)], owner[j]);
      made.most[at(point)] = std::max(made.most[at(point)], owner[j]);
    }
  }
  return made;
}

}  // namespace vorotool::core::voronoi
