// Lattice segments that cross, touch or overlap to segments that meet at common ends only: snap rounding
// (Hobby 1999; Guibas and Marimont 1998), confined to the neighborhood of what has to move.
//
// Every point, and every place where segments meet, rounded to the lattice, is a node; its cell (hot pixel)
// is [c - 1/2, c + 1/2) both ways. A segment that crosses another one at a place that is no lattice point has
// to move: it is loose. A loose segment goes through the centers of all cells of nodes that it meets, in
// order. A cell that a loose segment meets elsewhere than in its center is disturbed, and every segment that
// meets a disturbed cell is loose too. The others stay where they are, cut at the nodes that lie on them. A
// round makes at least one more segment loose, so that this ends; after some rounds all are made loose, which
// is the classical algorithm.
//
// Why no two pieces cross and no node lies inside a piece. On each loose segment take a point p in every
// cell that it meets, and let p move to the center c of the cell: p + t (c - p), 0 <= t <= 1. The pieces
// between consecutive ones stay straight. With B = [-1/2, 1/2)^2, which is convex and holds 0, p - c is in
// B, and so is any average of such differences. A point of a piece that moves is q + t d at time t, with q
// on its segment between its ends, and -d in B.
// 1. If a node w lies on a piece at time t, then q = w - t d is in w + B, the cell of w: the segment meets
//    it there, and w is an end of the piece. A piece of a segment that stays was cut at w, unless w is a
//    rounded crossing; but the cell of that is disturbed by what crosses there, and a segment through it
//    would be loose.
// 2. Two pieces e and f without a common node do not touch at t = 0: where two loose segments meet is in
//    the cell of a node, and where one that stays meets another is a node. At the first later t an end of
//    one would have come upon the other, say that of f in the cell of w, w + (1 - t) b with b in B, upon
//    e. If e is of a loose segment, q = w + (1 - t) b - t d is in w + B again, and w is an end of e. If e
//    stays, the end of f has moved, the cell of w is disturbed, and e, which meets it, would be loose.
// 3. Two pieces with one common node could only overlap; then 1 holds for the other end of the shorter
//    one.
#pragma once

#include <cstdint>
#include <vector>

#include "core/arrangement/segment_intersections.hpp"
#include "core/base/monitor.hpp"

namespace vorotool::core::arrangement {

struct SnappedSegments {
  // Nodes that are no points of the input, sorted; numbered from n on
  std::vector<kernel::LatticePoint> new_points;
  // Segment s goes through chain[chain_start[s]] ... chain[chain_start[s + 1] - 1]: from its lower to its
  // upper end, both included.
  std::vector<std::int32_t> chain_start, chain;
  std::vector<std::uint8_t> is_loose;  // [m] whether a segment was moved
};

SnappedSegments snap_segments(const SortedSegments& segments, const SweepResult& swept,
                              const base::Monitor& monitor);

}  // namespace vorotool::core::arrangement
