// Lattice segments that cross, touch or overlap to segments that meet at common ends only: snap rounding
// (Hobby 1999; Guibas and Marimont 1998), confined to the neighbourhood of what has to move.
//
// Every point, and every place where segments meet, rounded to the lattice, is a node; its cell (hot pixel)
// is [c - 1/2, c + 1/2) both ways. A segment that crosses another one at a place that is no lattice point has
// to move: it is loose. A loose segment goes through the centres of all cells of nodes that it meets, in
// order. A cell that a loose segment meets elsewhere than in its centre is disturbed, and every segment that
// meets a disturbed cell is loose too. The others stay where they are, cut at the nodes that lie on them. A
// round makes at least one more segment loose, so that this ends; after some rounds all are made loose, which
// is the classical algorithm.
//
// Why no two pieces cross and no node lies inside a piece. Let a loose segment be carried along while all
// points of it in a cell shrink towards the centre, p_t = c + (1 - t) (p - c), 0 <= t <= 1: pieces between
// consecutive nodes stay straight.
// 1. A node w on a piece e at time t: the point of e there came from w + (1 - t) 0 minus t times an average
// of
//    displacements c - p of the two ends, so it was in the cell of w (cells are convex and all alike): the
//    segment of e meets that cell, and w is an end of e. If e is of a segment that stays, it was cut at w,
//    unless w is a rounded crossing whose cell is disturbed by the segments that cross there: then the
//    segment of e, which meets it in the centre, would be loose.
// 2. Two pieces e and f that do not have a node in common never touch. They do not at t = 0: where their
//    segments meet is in the cell of a node, for loose ones, or at a node. At the first t > 0 an end of one
//    would have come upon the other, say the end p_t of f, in the cell of w, upon e. If e is loose, the point
//    of e there came from the cell of w as in 1, so w is an end of e. If e stays, then p has moved, the cell
//    of w is disturbed, and e meets it: e would be loose.
// 3. Two pieces with one node in common could only overlap, and then 1 applies to the end of the shorter one.
#pragma once

#include <cstdint>
#include <vector>

#include "core/monitor.hpp"
#include "core/segment_sweep.hpp"

namespace vorotool::core {

struct SnappedSegments {
  std::vector<LatticePoint> new_points;  // nodes that are no points of the input, sorted; numbered from n on
  // Segment s goes through chain[chain_start[s]] ... chain[chain_start[s + 1] - 1]: from its lower to its
  // upper end, both included.
  std::vector<std::int32_t> chain_start, chain;
  std::vector<std::uint8_t> is_loose;  // [m] whether a segment was moved
};

SnappedSegments snap_segments(const SortedSegments& segments, const SweepResult& swept,
                              const Monitor& monitor);

}  // namespace vorotool::core
