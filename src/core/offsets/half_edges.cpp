#include "core/offsets/half_edges.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "core/base/indices.hpp"

namespace vorotool::core::offsets {

HalfEdges::HalfEdges(const segment_voronoi::build::DiagramView& diagram)
    : diagram_(diagram), leaving_(diagram.vertex_sites.size()) {
  std::fill_n(leaving_.data(), leaving_.size(), no_edge);
  for (HalfEdge h = 0; h < size(); ++h) {
    if (tail(h) >= 0) {
      leaving_[slot(tail(h), left(h))] = h;
    } else {
      infinite_.emplace_back(left(h), h);
    }
  }
  if (std::count(leaving_.data(), leaving_.data() + leaving_.size(), no_edge) > 0) {
    throw std::invalid_argument("a vertex has sites without edges between them");
  }
  std::sort(infinite_.begin(), infinite_.end());
}

// Rings have three sites nearly always.
std::size_t HalfEdges::slot(std::int32_t vertex, std::int32_t site) const {
  const std::size_t v = base::at(vertex), last = base::at(diagram_.vertex_start[v + 1]);
  for (std::size_t k = base::at(diagram_.vertex_start[v]); k < last; ++k) {
    if (diagram_.vertex_sites[k] == site) return k;
  }
  throw std::invalid_argument("vertex " + std::to_string(vertex) + " has an edge at site " +
                              std::to_string(site) + ", which is not one of its own");
}

// A cell is unbounded once, or twice: then it is a strip, and what comes back on the same side of it is
// parallel.
HalfEdge HalfEdges::from_infinity(HalfEdge h) const {
  const auto comes_before = [](const auto& entry, std::int32_t site) { return entry.first < site; };
  auto found = std::lower_bound(infinite_.begin(), infinite_.end(), left(h), comes_before);
  const auto is_own = [&](auto entry) { return entry != infinite_.end() && entry->first == left(h); };
  if (!is_own(found)) throw std::invalid_argument("a cell is open at infinity");
  if (!is_own(found + 1)) return found->second;
  return kernel::dot(way(h), way(found->second)) < 0 ? found->second : (found + 1)->second;
}

kernel::Point HalfEdges::way(HalfEdge h) const {
  const kernel::LatticeSite a = diagram_.site(left(h)), b = diagram_.site(right(h));
  const auto sum = [](std::int32_t p, std::int32_t q) { return std::int64_t{p} + q; };
  return {static_cast<double>(sum(a.a.y, a.b.y) - sum(b.a.y, b.b.y)),
          static_cast<double>(sum(b.a.x, b.b.x) - sum(a.a.x, a.b.x))};
}

}  // namespace vorotool::core::offsets
