#include "core/segment_voronoi/build/wanted_faces.hpp"

#include <cstddef>

#include "core/kernel/lattice.hpp"

namespace vorotool::core::segment_voronoi::build {

using kernel::LatticePoint;

namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

constexpr std::int32_t unknown = -1;

using Pairs = std::span<const std::array<std::int32_t, 2>>;

kernel::LatticeVector way_from(std::span<const LatticePoint> points, Pairs segments, std::int32_t end,
                               std::int32_t segment) {
  const auto& ends = segments[at(segment)];
  return points[at(ends[0] == end ? ends[1] : ends[0])] - points[at(end)];
}

// The sector over 180 degrees at each point begins at the segment to the left of which no other one leaves.
std::vector<std::int32_t> sector_borders(std::span<const LatticePoint> points, Pairs segments) {
  std::vector<std::int32_t> border(points.size(), unknown);
  for (std::size_t j = 0; j < segments.size(); ++j) {
    const auto segment = static_cast<std::int32_t>(j);
    for (const std::int32_t end : segments[j]) {
      std::int32_t& so_far = border[at(end)];
      if (so_far == unknown || kernel::cross(way_from(points, segments, end, so_far),
                                             way_from(points, segments, end, segment)) > 0) {
        so_far = segment;
      }
    }
  }
  return border;
}

std::int32_t face_left_of(Pairs segments, Pairs faces, std::int32_t segment, std::size_t end) {
  return faces[at(segment)][at(segments[at(segment)][0]) == end ? 0 : 1];
}

}  // namespace

std::vector<std::int32_t> point_faces(std::span<const LatticePoint> points, Pairs segments,
                                      Pairs segment_faces) {
  std::vector<std::int32_t> face = sector_borders(points, segments);
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (face[i] != unknown) face[i] = face_left_of(segments, segment_faces, face[i], i);
  }
  return face;
}

// Where no sector is over 180 degrees there is no cell, or one without area that may lie in two faces: it is
// not unwanted, and its neighbours tell.
std::vector<std::uint8_t> unwanted_sides(std::span<const LatticePoint> points, Pairs segments,
                                         Pairs segment_faces, std::span<const std::uint8_t> is_wanted) {
  const auto is_unwanted = [&](std::int32_t face) { return is_wanted[at(face)] == 0; };
  const std::vector<std::int32_t> border = sector_borders(points, segments);
  std::vector<std::uint8_t> unwanted(points.size(), unwanted_left | unwanted_right);
  unwanted.reserve(points.size() + segments.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (border[i] != unknown && !is_unwanted(face_left_of(segments, segment_faces, border[i], i)))
      unwanted[i] = 0;
  }
  for (std::size_t j = 0; j < segments.size(); ++j) {
    const auto segment = static_cast<std::int32_t>(j);
    for (const std::int32_t end : segments[j]) {
      const std::int32_t first = border[at(end)];
      if (first == segment) continue;
      const kernel::LatticeVector way = way_from(points, segments, end, segment);
      if (kernel::cross(way_from(points, segments, end, first), way) >= 0) unwanted[at(end)] = 0;
    }
  }
  for (const auto& [left, right] : segment_faces) {
    unwanted.push_back(static_cast<std::uint8_t>((is_unwanted(left) ? unwanted_left : 0) |
                                                 (is_unwanted(right) ? unwanted_right : 0)));
  }
  return unwanted;
}

}  // namespace vorotool::core::segment_voronoi::build
