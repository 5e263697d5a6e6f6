// The outlines of the objects of a label image, along the cracks between pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/monitor.hpp"

namespace vorotool::core::label_images {

// How an outline goes on where two pixels of a label meet at a corner only.
enum class CornerRule : std::uint8_t {
  apart,    // 4-connectivity: they do not belong together by that
  divided,  // the same, and a ring that would visit the corner twice is divided there
  joined,   // 8-connectivity: they do, also where two labels cross at the corner
  yielding  // 8-connectivity, but where two labels cross only the smaller one goes through
};

// Corner (x, y) is that of the pixels in columns x - 1 and x and in rows y - 1 and y: from (0, 0) to
// (width, height). It is a vertex of the outlines unless cracks go straight through it and no other crack
// ends there, so that outlines of different labels have all vertices of a common stretch in common.
//
// Objects are the connected parts of each label but 0, by label and then by their first pixels, row by row.
// Each has one shell, and then its holes, by their first pixels. The object is on the left of its rings as x
// and y are stored: shells have a positive area, holes a negative one. A ring begins with its first vertex,
// row by row. With CornerRule::divided no ring visits a vertex twice; otherwise each runs along one component
// of what is not its object, so that it may touch itself in vertices. No two ever cross.
struct CrackOutlines {
  std::vector<base::IndexPair> corners;   // along the rings
  std::vector<std::int64_t> start;        // [r + 1]
  std::vector<std::int8_t> is_hole;       // [r]
  std::vector<std::int32_t> ring_object;  // [r] not decreasing
  std::vector<std::uint32_t> labels;      // of the objects, not decreasing
};

// Images are row-major, of uint8_t, uint16_t or uint32_t, with sides below 2^31.

// The number of vertices of all outlines, each place once.
template <class Label>
std::size_t count_crack_vertices(std::span<const Label> image, std::size_t width, unsigned threads,
                                 const base::Monitor& monitor);

// There must be fewer than 2^31 vertices. The result does not depend on the threads.
template <class Label>
CrackOutlines trace_cracks(std::span<const Label> image, std::size_t width, CornerRule rule, unsigned threads,
                           const base::Monitor& monitor);

}  // namespace vorotool::core::label_images
