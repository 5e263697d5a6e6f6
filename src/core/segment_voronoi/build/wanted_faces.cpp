#include "core/segment_voronoi/build/wanted_faces.hpp"

#include <cstddef>

#include "core/base/indices.hpp"

namespace vorotool::core::segment_voronoi::build {

using base::at;
using kernel::PlanarGraphView;

namespace {

constexpr std::int32_t unknown = -1;

// The sector over 180 degrees at each point begins at the segment to the left of which no other one leaves.
std::vector<std::int32_t> sector_borders(const PlanarGraphView& graph) {
  std::vector<std::int32_t> border(graph.points.size(), unknown);
  for (std::size_t site = border.size(); site < graph.site_count(); ++site) {
    const auto segment = static_cast<std::int32_t>(site);
    for (const std::int32_t end : graph.ends(segment)) {
      std::int32_t& so_far = border[at(end)];
      if (so_far == unknown || kernel::cross(graph.way_from(end, so_far), graph.way_from(end, segment)) > 0) {
        so_far = segment;
      }
    }
  }
  return border;
}

std::int32_t face_left_of(const PlanarGraphView& graph, std::int32_t segment, std::size_t end) {
  return graph.faces[graph.segment_of(segment)][at(graph.ends(segment)[0]) == end ? 0 : 1];
}

}  // namespace

std::vector<std::int32_t> point_faces(const PlanarGraphView& graph) {
  std::vector<std::int32_t> face = sector_borders(graph);
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (face[i] != unknown) face[i] = face_left_of(graph, face[i], i);
  }
  return face;
}

// Where no sector is over 180 degrees there is no cell, or one without area that may lie in two faces: it is
// not unwanted, and its neighbors tell.
std::vector<std::uint8_t> unwanted_sides(const PlanarGraphView& graph,
                                         std::span<const std::uint8_t> is_wanted) {
  const auto is_unwanted = [&](std::int32_t face) { return is_wanted[at(face)] == 0; };
  const std::vector<std::int32_t> border = sector_borders(graph);
  std::vector<std::uint8_t> unwanted(border.size(), unwanted_left | unwanted_right);
  unwanted.reserve(graph.site_count());
  for (std::size_t i = 0; i < border.size(); ++i) {
    if (border[i] != unknown && !is_unwanted(face_left_of(graph, border[i], i))) unwanted[i] = 0;
  }
  for (std::size_t site = border.size(); site < graph.site_count(); ++site) {
    const auto segment = static_cast<std::int32_t>(site);
    for (const std::int32_t end : graph.ends(segment)) {
      const std::int32_t first = border[at(end)];
      if (first == segment) continue;
      if (kernel::cross(graph.way_from(end, first), graph.way_from(end, segment)) >= 0) unwanted[at(end)] = 0;
    }
  }
  for (const auto& [left, right] : graph.faces) {
    unwanted.push_back(static_cast<std::uint8_t>((is_unwanted(left) ? unwanted_left : 0) |
                                                 (is_unwanted(right) ? unwanted_right : 0)));
  }
  return unwanted;
}

}  // namespace vorotool::core::segment_voronoi::build
