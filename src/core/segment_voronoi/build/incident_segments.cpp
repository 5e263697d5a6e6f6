#include "core/segment_voronoi/build/incident_segments.hpp"

#include <algorithm>

namespace vorotool::core::segment_voronoi::build {

using kernel::LatticeVector;

namespace {

bool is_lower(const LatticeVector& v) { return v.y < 0 || (v.y == 0 && v.x < 0); }

bool earlier(const LatticeVector& v, const LatticeVector& w) {
  return is_lower(v) != is_lower(w) ? is_lower(w) : kernel::cross(v, w) > 0;
}

}  // namespace

IncidentSegments::IncidentSegments(const kernel::PlanarGraphView& graph)
    : graph_(graph), segments_(graph.points.size(), [&](const auto& add) {
        for (std::size_t j = 0; j < graph.segments.size(); ++j) {
          for (const std::int32_t end : graph.segments[j])
            add(end, static_cast<std::int32_t>(graph.points.size() + j));
        }
      }) {
  for (std::int32_t point = 0; point < static_cast<std::int32_t>(segments_.size()); ++point) {
    std::ranges::sort(segments_[point], [&](std::int32_t s, std::int32_t t) {
      return earlier(graph_.way_from(point, s), graph_.way_from(point, t));
    });
  }
}

std::int32_t IncidentSegments::between(std::int32_t p, std::int32_t q) const {
  const std::int32_t fewer = at(p).size() < at(q).size() ? p : q, other = fewer == p ? q : p;
  for (const std::int32_t segment : at(fewer)) {
    if (graph_.is_end(other, segment)) return segment;
  }
  return -1;
}

bool IncidentSegments::wide_gap_after(std::int32_t point, std::size_t i) const {
  const auto segments = at(point);
  const std::int32_t following = segments[(i + 1) % segments.size()];
  return kernel::cross(graph_.way_from(point, segments[i]), graph_.way_from(point, following)) <= 0;
}

bool IncidentSegments::has_no_cell(std::int32_t point) const {
  for (std::size_t i = 0; i < at(point).size(); ++i) {
    if (wide_gap_after(point, i)) return false;
  }
  return !at(point).empty();
}

std::vector<std::int32_t> IncidentSegments::corner_ring(std::int32_t point) const {
  const auto segments = at(point);
  if (segments.size() < 2) return {};
  std::vector<std::int32_t> ring;
  int wide = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    ring.push_back(segments[i]);
    if (!wide_gap_after(point, i)) continue;
    ring.push_back(point);
    ++wide;
  }
  if (wide > 1) return {};  // two gaps of 180 degrees
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  return ring;
}

}  // namespace vorotool::core::segment_voronoi::build
