// The triangulation that section 2.1 of the paper reads off a digital Voronoi tessellation, to the letter.
//
// Edges link neighboring regions: two that have 4-neighboring pixels. Triangles come from single pixels: a
// pixel and two of its 4-neighbors that are 8-neighbors of each other, if their labels differ. Such three
// pixels lie around one corner of the lattice. Where four labels meet, all four triples are triangles, which
// overlap; a side of a triangle need not be an edge. Label 0 is no region.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"

namespace vorotool::core::digital {

struct LabelPair {
  std::uint32_t a, b;  // a < b
};

struct LabelTriple {
  std::uint32_t a, b, c;  // a < b < c
  std::uint8_t corners;   // bit 0: found where three labels meet; bit 1: where four do
};

struct DigitalTriangulation {
  std::vector<LabelPair> edges;        // in lexicographic order
  std::vector<LabelTriple> triangles;  // in lexicographic order
  std::uint64_t three_label_corners = 0;
  std::uint64_t four_label_corners = 0;
};

// Reads an image from the top, band by band; nothing of the image is kept. The result does not depend on how
// the rows were cut into bands, nor on the threads.
class DigitalTriangulationScan {
 public:
  // Consecutive rows (uint8_t, uint16_t or uint32_t labels, at least one row). The first row of every band
  // but the first is the last row of the band before, given again.
  template <class Label>
  void add_rows(std::span<const Label> rows, std::size_t width, unsigned threads,
                const base::Monitor& monitor);

  DigitalTriangulation finish();

 private:
  DigitalTriangulation found_;  // in no order, with repetitions
};

}  // namespace vorotool::core::digital
