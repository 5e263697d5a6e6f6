#include "core/segment_voronoi/verify/combinatorial_map.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <unordered_map>

#include "core/kernel/lattice.hpp"

namespace vorotool::core::segment_voronoi::verify {

using base::Fault;
using build::DiagramView;
using build::IncidentSegments;
using kernel::LatticePoint;

namespace {

using Site = std::int32_t;

constexpr std::size_t none = static_cast<std::size_t>(-1);

// As kernel::lexicographic_less, written again: a checker shares no order with what it checks.
bool comes_before(const LatticePoint& a, const LatticePoint& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

// From the lexicographically first point counter-clockwise, with all points on the sides; a chain there and
// back if all are on one line. (Andrew's monotone chains.)
std::vector<Site> hull_of(std::span<const LatticePoint> points) {
  std::vector<Site> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  auto at = [&](Site i) -> const LatticePoint& { return points[static_cast<std::size_t>(i)]; };
  std::sort(order.begin(), order.end(), [&](Site i, Site j) { return comes_before(at(i), at(j)); });
  std::vector<Site> hull;
  auto chain = [&](const auto& first, const auto& last) {
    const std::size_t start = hull.size();
    for (auto i = first; i != last; ++i) {
      while (hull.size() >= start + 2 &&
             kernel::cross(at(hull.back()) - at(hull[hull.size() - 2]), at(*i) - at(hull.back())) < 0) {
        hull.pop_back();
      }
      hull.push_back(*i);
    }
    hull.pop_back();  // the next chain begins with it
  };
  if (points.size() < 2) return order;
  chain(order.begin(), order.end());
  chain(order.rbegin(), order.rend());
  return hull;
}

}  // namespace

std::vector<Site> cells_at_infinity(const DiagramView& arrays, const IncidentSegments& incident) {
  const std::vector<Site> hull = hull_of(arrays.points);
  std::vector<Site> cells;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Site next = hull[(i + 1) % hull.size()];
    cells.push_back(hull[i]);
    const Site segment = next == hull[i] ? -1 : incident.between(hull[i], next);
    if (segment >= 0) cells.push_back(segment);
  }
  std::reverse(cells.begin(), cells.end());
  return cells;
}

namespace {

// Half-edge 2 k leaves the source of edge k, 2 k + 1 its target; the other half is its twin.
class Map {
 public:
  Map(const DiagramView& arrays, const IncidentSegments& incident)
      : in_(arrays),
        incident_(incident),
        at_infinity_(cells_at_infinity(arrays, incident)),
        half_at_(arrays.vertex_sites.size() + at_infinity_.size(), none),
        slot_(2 * arrays.edges.size()) {
    for (std::size_t i = 0; i < at_infinity_.size(); ++i) {
      const Site next = at_infinity_[(i + 1) % at_infinity_.size()];
      infinite_slot_[key(at_infinity_[i], next)] = arrays.vertex_sites.size() + i;
    }
  }

  Fault check() {
    if (in_.site_count() < 2) {
      if (in_.vertex_count() == 0 && in_.edges.empty()) return {};
      return "there are vertices or edges, but fewer than two sites";
    }
    for (const auto step :
         {&Map::place_edges, &Map::check_rings_full, &Map::check_cells, &Map::check_connection}) {
      if (Fault fault = (this->*step)()) return fault;
    }
    return {};
  }

 private:
  static std::uint64_t key(Site right, Site left) {
    return static_cast<std::uint64_t>(right) << 32 | static_cast<std::uint32_t>(left);
  }

  Site left_of_half(std::size_t half) const { return in_.edge_sites[half / 2][half % 2]; }
  Site origin_of_half(std::size_t half) const { return in_.edges[half / 2][half % 2]; }
  std::string edge_text(std::size_t edge) const {
    return "edge " + std::to_string(edge) + " between the cells of " +
           std::to_string(in_.edge_sites[edge][0]) + " and " + std::to_string(in_.edge_sites[edge][1]);
  }

  // The place in the ring of v after which the edge with these sites leaves; or none.
  std::size_t find_slot(Site vertex, Site right, Site left) {
    if (vertex < 0) {
      const auto found = infinite_slot_.find(key(right, left));
      return found == infinite_slot_.end() ? none : found->second;
    }
    const auto ring = in_.ring(static_cast<std::size_t>(vertex));
    const auto start = static_cast<std::size_t>(in_.vertex_start[static_cast<std::size_t>(vertex)]);
    const std::size_t i = place_in(ring, start, right);
    return i != none && ring[(i + 1) % ring.size()] == left ? start + i : none;
  }

  std::size_t place_in(std::span<const Site> ring, std::size_t start, Site site) {
    if (ring.size() <= 16) {
      const auto found = std::find(ring.begin(), ring.end(), site);
      return found == ring.end() ? none : static_cast<std::size_t>(found - ring.begin());
    }
    auto& places = long_rings_[start];
    if (places.empty()) {
      for (std::size_t i = 0; i < ring.size(); ++i) places[ring[i]] = i;
    }
    const auto found = places.find(site);
    return found == places.end() ? none : found->second;
  }

  Fault place_edges() {
    for (std::size_t half = 0; half < slot_.size(); ++half) {
      const std::size_t slot = find_slot(origin_of_half(half), left_of_half(half ^ 1), left_of_half(half));
      const std::string end = half % 2 == 0 ? "source" : "target";
      if (slot == none) return edge_text(half / 2) + " does not fit the ring of its " + end;
      if (half_at_[slot] != none) {
        return edge_text(half / 2) + " and edge " + std::to_string(half_at_[slot] / 2) +
               " have one place at the " + end + " of the first";
      }
      half_at_[slot] = half;
      slot_[half] = slot;
    }
    return {};
  }

  Fault check_rings_full() {
    const auto missing = std::find(half_at_.begin(), half_at_.end(), none);
    if (missing == half_at_.end()) return {};
    const auto slot = static_cast<std::size_t>(missing - half_at_.begin());
    if (slot >= in_.vertex_sites.size()) {
      const std::size_t i = slot - in_.vertex_sites.size();
      return "no edge goes to infinity between the cells of " + std::to_string(at_infinity_[i]) + " and " +
             std::to_string(at_infinity_[(i + 1) % at_infinity_.size()]);
    }
    const auto after =
        std::upper_bound(in_.vertex_start.begin(), in_.vertex_start.end(), static_cast<Site>(slot));
    return "vertex " + std::to_string(after - in_.vertex_start.begin() - 1) + " has no edge after site " +
           std::to_string(in_.vertex_sites[slot]) + " of its ring";
  }

  // Along the cell on the left: the edge that leaves before, counter-clockwise, where this one arrives.
  std::size_t following(std::size_t half) const {
    const std::size_t slot = slot_[half ^ 1], finite = in_.vertex_sites.size();
    const Site vertex = origin_of_half(half ^ 1);
    const std::size_t start =
        vertex < 0 ? finite : static_cast<std::size_t>(in_.vertex_start[static_cast<std::size_t>(vertex)]);
    const std::size_t size =
        vertex < 0 ? at_infinity_.size() : in_.ring(static_cast<std::size_t>(vertex)).size();
    return half_at_[slot == start ? start + size - 1 : slot - 1];
  }

  Fault check_cells() {
    std::vector<char> seen(slot_.size());
    std::vector<int> cycles(in_.site_count());
    for (std::size_t first = 0; first < slot_.size(); ++first) {
      if (seen[first] != 0) continue;
      for (std::size_t half = first; seen[half] == 0; half = following(half)) seen[half] = 1;
      const Site site = left_of_half(first);
      if (++cycles[static_cast<std::size_t>(site)] > 1) {
        return "the edges around the cell of site " + std::to_string(site) + " make more than one cycle";
      }
    }
    for (std::size_t i = 0; i < cycles.size(); ++i) {
      const bool has_cell =
          !in_.is_point(static_cast<Site>(i)) || !incident_.has_no_cell(static_cast<Site>(i));
      if (has_cell && cycles[i] == 0) return "site " + std::to_string(i) + " has no cell";
      if (!has_cell && cycles[i] > 0) return "site " + std::to_string(i) + " must not have a cell";
      cells_ += cycles[i];
    }
    return {};
  }

  Fault check_connection() {
    std::vector<std::size_t> parent(in_.vertex_count() + 1);
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    auto root = [&](std::size_t v) {
      while (parent[v] != v) v = parent[v] = parent[parent[v]];
      return v;
    };
    std::size_t parts = parent.size();
    for (const auto& [source, target] : in_.edges) {
      const std::size_t a = root(static_cast<std::size_t>(source + 1)),
                        b = root(static_cast<std::size_t>(target + 1));
      if (a != b) --parts;
      parent[a] = b;
    }
    if (parts > 1) return "the edges are in " + std::to_string(parts) + " parts that are not connected";
    const auto vertices = static_cast<std::int64_t>(in_.vertex_count()) + 1;
    const auto edges = static_cast<std::int64_t>(in_.edges.size());
    if (vertices - edges + cells_ == 2) return {};
    return "Euler's relation fails: " + std::to_string(vertices) + " vertices with infinity, " +
           std::to_string(edges) + " edges, " + std::to_string(cells_) + " cells";
  }

  const DiagramView& in_;
  const IncidentSegments& incident_;
  std::vector<Site> at_infinity_;
  std::vector<std::size_t> half_at_;  // [ring places] the half-edge that leaves after a site of a ring
  std::vector<std::size_t> slot_;     // [half-edges] its place
  std::unordered_map<std::uint64_t, std::size_t> infinite_slot_;
  std::unordered_map<std::size_t, std::unordered_map<Site, std::size_t>> long_rings_;  // by their starts
  std::int64_t cells_ = 0;
};

}  // namespace

Fault find_map_fault(const DiagramView& arrays, const IncidentSegments& incident) {
  return Map(arrays, incident).check();
}

}  // namespace vorotool::core::segment_voronoi::verify
