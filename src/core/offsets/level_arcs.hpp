// The arcs of a level within the cells of a segment Voronoi diagram, as crossings of borders tell them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/kernel/point.hpp"
#include "core/offsets/level_crossings.hpp"

namespace vorotool::core::offsets {

// A piece of a curve, what is near on its left: across the cell to the right of the first half-edge, which is
// to the left of the last one.
struct Piece {
  HalfEdge first, last;
};

class LevelArcs {
 public:
  LevelArcs(const HalfEdges& borders, LevelCrossings& crossings, double level);

  // The site in whose cell a piece is.
  std::int32_t site(const Piece& piece) const { return borders_.left(piece.last); }
  // Whether no segment ends at a point.
  bool is_lone(std::int32_t point) const { return is_lone_[static_cast<std::size_t>(point)]; }

  // Whether a piece is about the common end of two segments on one line.
  bool is_between_aligned(const PolygonFaces& domain, const Piece& piece) const;
  // Whether rounding leaves nothing of an arc about a point.
  bool is_lost(const Piece& piece) const;

  // Whether a piece is over half a circle, or nearly so, which only those about points without segments are.
  bool is_long(const Piece& piece) const;
  // The middle of a long arc: across its chord, or where that is short away from its ends.
  kernel::Point middle(const Piece& piece) const;

  // Points without segments whose cells are around the whole circle, each with a half-edge of its border; that
  // is no_edge of a single site.
  struct Circle {
    std::int32_t point;
    HalfEdge border;
  };
  std::vector<Circle> circles(const PolygonFaces& domain, const LevelSet& level) const;

  kernel::Point center_of(std::int32_t point) const;

 private:
  double turn(const Piece& piece) const;

  const HalfEdges& borders_;
  const segment_voronoi::build::DiagramView& diagram_;
  LevelCrossings& crossings_;
  double level_;
  std::vector<bool> is_lone_;  // [n]
};

}  // namespace vorotool::core::offsets
