// A segment Voronoi diagram as flat arrays: coincident vertices merged, everything in an order that depends
// on the input only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/segment_voronoi/build/segment_insertion.hpp"
#include "core/segment_voronoi/discs/sites.hpp"

namespace vorotool::core::segment_voronoi::build {

// Sites have the numbers of the input: points first, then segments. What comes first is decided by the order
// in which the engine works on the sites, that of a curve through the points: it depends on where they are,
// not on how they are numbered.
struct DiagramArrays {
  base::LargeArray<double> vertices;            // [2 v] in the order of the lists of their sites
  base::LargeArray<double> radius;              // [v]
  base::LargeArray<std::int32_t> vertex_start;  // [v + 1] where the sites of each vertex begin
  // All sites that the disc of a vertex touches and whose cells meet there, counter-clockwise from the
  // smallest number.
  base::LargeArray<std::int32_t> vertex_sites;
  // [2 e] source and target; -1 at infinity, as source only of edges that have no vertex. These come first;
  // the others with their source, the end with the smaller number, counter-clockwise around it.
  base::LargeArray<std::int32_t> edges;
  base::LargeArray<std::int32_t> edge_sites;  // [2 e] on the left and on the right
};

// `given` are the numbers of the sites in the input. With `unwanted`, their sides by these numbers
// (core/segment_voronoi/build/wanted_faces.hpp), vertices there are left out, but for corners, and so are the
// edges to them. The memory of the records is given back as the arrays are filled, so that both are never
// there as a whole.
DiagramArrays extract_diagram(discs::SegmentSites sites, VoronoiRecords records,
                              std::span<const std::int32_t> given, std::span<const std::uint8_t> unwanted,
                              unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::segment_voronoi::build
