// A segment Voronoi diagram as flat arrays: coincident vertices merged, everything in an order that depends
// on the input only.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/monitor.hpp"
#include "core/segment_voronoi/build/diagram.hpp"
#include "core/segment_voronoi/build/segment_insertion.hpp"
#include "core/segment_voronoi/discs/sites.hpp"

namespace vorotool::core::segment_voronoi::build {

// `given` are the numbers of the sites in the input. With `unwanted`, their sides by these numbers
// (core/segment_voronoi/build/wanted_faces.hpp), vertices there are left out, but for corners, and so are the
// edges to them. The memory of the records is given back as the arrays are filled, so that both are never
// there as a whole.
Diagram extract_diagram(discs::SegmentSites sites, VoronoiRecords records,
                        std::span<const std::int32_t> given, std::span<const std::uint8_t> unwanted,
                        unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::segment_voronoi::build
