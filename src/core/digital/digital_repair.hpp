// A Delaunay triangulation from a digital tessellation, repaired (paper, section 2.1; the idea of Rong, Tan,
// Cao and Stephanus, "Computing two-dimensional Delaunay triangulation using graphics hardware").
//
// 1. Regions are made 4-connected.
// 2. A corner of three labels is a triangle, one of four labels two.
// 3. Sites that are left with two neighbors are taken out.
// 4. The frame is closed: the labels around it are a polygon, whose reflex turns are filled.
// 5. Sides that are not locally Delaunay are flipped.
// 6. Sites that are in no triangle yet are inserted where they lie.
// Where steps 2 and 3 leave no triangulation all sites are inserted one by one.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/monitor.hpp"
#include "core/delaunay/divide_and_conquer.hpp"
#include "core/digital/connected_regions.hpp"

namespace vorotool::core::digital {

// Counts of the repair's steps.
struct DigitalRepair {
  std::uint64_t split_regions = 0;
  std::uint64_t moved_pixels = 0;
  std::uint64_t three_label_corners = 0;
  std::uint64_t four_label_corners = 0;
  std::uint64_t twins = 0;         // sites with two neighbors, taken out
  std::uint64_t straightened = 0;  // triangles of collinear sites
  std::uint64_t filled = 0;        // turns of the frame
  std::uint64_t flipped = 0;       // sides, before sites were inserted
  std::uint64_t inserted = 0;      // sites, those taken out among them
  enum Route : std::uint8_t { chain, repaired, rebuilt } route = chain;
};

struct DigitalSites {
  std::span<const std::int64_t> x, y;  // [n] on a lattice; site k has label k + 1
  std::int64_t scale;                  // lattice steps a pixel
};

// `image` holds the exact tessellation of the sites, every pixel labelled; its regions are changed. `ordered`
// holds the distinct ones of the same sites as points.
delaunay::Subdivision digital_delaunay(std::span<std::uint32_t> image, const tessellation::PixelFrame& frame,
                                       const DigitalSites& sites, const delaunay::OrderedPoints& ordered,
                                       DigitalRepair& repair, unsigned threads, const base::Monitor& monitor);

// The same by insertion of all points one by one.
delaunay::Subdivision delaunay_by_insertion(const delaunay::OrderedPoints& ordered,
                                            const base::Monitor& monitor);

}  // namespace vorotool::core::digital
