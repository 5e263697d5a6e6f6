// The vertices of a segment Voronoi diagram while it is built: a triangulation of the sphere whose corners
// are sites.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "core/segment_voronoi/discs/sites.hpp"

namespace vorotool::core::segment_voronoi::discs {

// Corner i of record v has the number 4 v + i. It also stands for the half of an edge opposite to the site at
// the corner.
using Corner = std::int32_t;

inline Corner corner_of(std::int32_t record, int i) { return 4 * record + i; }
inline std::int32_t record_of(Corner corner) { return corner >> 2; }
inline int place_of(Corner corner) { return corner & 3; }
inline int following(int i) { return i == 2 ? 0 : i + 1; }
inline int preceding(int i) { return i == 0 ? 2 : i - 1; }

struct alignas(64) VoronoiRecord {
  std::array<SiteIndex, 3> sites;  // counter-clockwise around the vertex
  // The corner across the edge opposite to each site: the edge between the following two sites. Corners, not
  // records: two vertices may share two edges, and pairs of sites may share several.
  std::array<Corner, 3> twins;
  double x, y;            // center of the disc that touches the sites; indeterminate at infinity
  double radius;          // infinite if one site is the one at infinity
  float position_error;   // bounds the distance of (x, y) from the true center
  float radius_error;     // bounds the error of the radius
  std::int32_t stamp;     // the last attempt that tested this vertex: twice its number, plus 1 if in conflict
  std::uint8_t left;      // bit i: site i is a segment, and the disc lies to the left of it
  std::uint8_t survives;  // bit i: the middle of edge i survives the insertion that is going on
  std::uint16_t owner;    // the thread that may look at the record and change it; 0: none

  bool is_infinite() const { return radius == std::numeric_limits<double>::infinity(); }
  bool is_left(int i) const { return (left >> i & 1) != 0; }
  // The place of a site, or -1.
  int find(SiteIndex site) const {
    return sites[0] == site ? 0 : sites[1] == site ? 1 : sites[2] == site ? 2 : -1;
  }
};
static_assert(sizeof(VoronoiRecord) == 64);

// The sites right and left of edge i as it leaves the vertex.
struct EdgeSites {
  SiteIndex right, left;
};
inline EdgeSites sites_of_edge(const VoronoiRecord& v, int i) {
  return {v.sites[static_cast<std::size_t>(following(i))], v.sites[static_cast<std::size_t>(preceding(i))]};
}

}  // namespace vorotool::core::segment_voronoi::discs
