#include "core/cells/cell_measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/parallel.hpp"
#include "core/numbers/elementary.hpp"

namespace vorotool::core::cells {

using kernel::Point;

namespace {

constexpr std::size_t measures_a_piece = std::size_t{1} << 13;

// Twice the signed area, of coordinates times 2^scale relative to the first vertex: products do not overflow.
double twice_area(std::span<const Point> ring, double factor) {
  const Point& origin = ring[0];
  const auto from_origin = [&](const Point& p) {
    return Point{(p.x - origin.x) * factor, (p.y - origin.y) * factor};
  };
  double sum = 0;
  Point p = from_origin(ring.back());
  for (const Point& vertex : ring) {
    const Point q = from_origin(vertex);
    sum += p.x * q.y - q.x * p.y;
    p = q;
  }
  return sum;
}

double length(std::span<const Point> ring) {
  double sum = distance(ring.back(), ring.front());
  for (std::size_t k = 1; k < ring.size(); ++k) sum += distance(ring[k - 1], ring[k]);
  return sum;
}

}  // namespace

CellMeasures measure_cells(const CellOutlines& cells, const Box& frame, unsigned threads,
                           const base::Monitor& monitor) {
  CellMeasures result(cells.sites.size());
  const double half = std::max(frame.right / 2 - frame.left / 2, frame.top / 2 - frame.bottom / 2);
  const int scale = std::clamp(-std::ilogb(half), -1000, 1000);
  const double factor = std::ldexp(1.0, scale);
  const auto on_frame = [&](const Point& p) {
    return p.x == frame.left || p.x == frame.right || p.y == frame.bottom || p.y == frame.top;
  };
  const auto add_ring = [&](std::size_t cell, std::span<const Point> ring) {
    result.area[cell] += std::ldexp(twice_area(ring, factor), -2 * scale - 1);
    result.perimeter[cell] += length(ring);
    for (const Point& p : ring) {
      result.reach[cell] = std::max(result.reach[cell], distance(p, cells.sites[cell]));
      result.touches_frame[cell] |= on_frame(p);
    }
  };
  base::for_items(cells.sites.size(), measures_a_piece, threads, monitor, [&](std::size_t cell) {
    for (auto r = cells.cell_rings[cell]; r < cells.cell_rings[cell + 1]; ++r) {
      const auto ring = static_cast<std::size_t>(r);
      const auto begin = static_cast<std::size_t>(cells.rings[ring]);
      add_ring(cell, cells.vertices.subspan(begin, static_cast<std::size_t>(cells.rings[ring + 1]) - begin));
    }
  });
  return result;
}

}  // namespace vorotool::core::cells
