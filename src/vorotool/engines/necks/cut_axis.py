"""Skeletons cut at necks: their connected parts, and walks around these from cut to cut."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.from_skeleton.contour_walk import contours_of, site_points
from vorotool.engines.necks.axis import Ways
from vorotool.engines.necks.feet import Feet
from vorotool.numeric.ragged import following, owners
from vorotool.plain import plain
from vorotool.types.skeleton.skeleton import EDGE, Skeleton
from vorotool.types.skeleton.tables import connected_roots

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


@plain(eq=False)
class CutAxis:
    """A skeleton in which each cut has two nodes of its own, one for each way."""

    skeleton: Skeleton  # arcs that a cut is inside of are two, of which only ends and sites mean anything
    node: Indices  # (c, 2) int64 array: those of each cut
    part: Indices  # (v,) int64 array: the connected part of each node; the boundary parts what meets in corners


def cut_axis(skeleton: Skeleton, ways: Ways, xy: Floats, width: Floats) -> CutAxis:
    """Cut a skeleton at some necks."""
    old, count = len(skeleton.vertices), len(ways)
    node = old + np.arange(2 * count).reshape(-1, 2)
    arcs = skeleton.arcs.astype(np.int64)
    inside = np.flatnonzero(ways.is_inside)
    between = np.flatnonzero(~ways.is_inside)
    arcs[ways.arc[between], ways.end[between]] = node[between]
    # the second way of a neck inside an arc takes a new one
    cut, far_end = ways.arc[inside, 0], 1 - ways.end[inside, 1]
    halves = np.empty((len(inside), 2), dtype=np.int64)
    halves[np.arange(len(inside)), far_end] = arcs[cut, far_end]
    halves[np.arange(len(inside)), 1 - far_end] = node[inside, 1]
    arcs[cut, ways.end[inside, 0]] = node[inside, 0]
    every = np.concatenate([np.arange(len(skeleton)), cut])
    own = ("control", "sites", "polygon", "side", "branch", "length", "error_bound")
    made = replace(
        skeleton,
        vertices=np.concatenate([skeleton.vertices, np.repeat(xy, 2, axis=0)]),
        radius=np.concatenate([skeleton.radius, np.repeat(width / 2, 2)]),
        arcs=np.concatenate([arcs, halves]),
        **{name: getattr(skeleton, name)[every] for name in own},
    )
    return CutAxis(made, node, _parts(made))


def _parts(skeleton: Skeleton) -> Indices:
    """(v,) the smallest node that each is connected with, not through corners: of these one way's at random."""
    ends = skeleton.arcs.astype(np.int64)
    is_corner = skeleton.radius[ends] == 0
    apart = len(skeleton.vertices) + np.arange(ends.size).reshape(-1, 2)
    return connected_roots(np.where(is_corner, apart, ends), len(skeleton.vertices) + ends.size)[: len(skeleton.radius)]


@plain(eq=False)
class Outlines:
    """Vertices around the parts of a cut skeleton, contour after contour."""

    xy: Floats  # (n, 2) float64 array: their places
    # (n,) int64 array: equal places of vertices of the polygons have the same number; feet on edges have -1
    point: Indices
    edge: Indices  # (n,) int64 array: the edge along which the contour goes on from each; -1 along a cut
    start: Indices  # (k + 1,) int64 array: where each contour begins
    part: Indices  # (k,) int64 array: the connected part that it goes around
    polygon: Indices  # (k,) int64 array: the polygon of this


def outlines_of(axis: CutAxis, feet: Feet) -> Outlines:
    """Walk around the parts of a skeleton, along the boundary and across the cuts."""
    skeleton = axis.skeleton
    walk = contours_of(skeleton, np.arange(len(skeleton)))
    ends, points = skeleton.site_ends, site_points(skeleton)
    is_edge = skeleton.site_table.kind[walk.site] == EDGE
    cut = np.full(len(skeleton.vertices), -1)
    cut[axis.node] = np.arange(axis.node.size).reshape(-1, 2)
    passed = cut[walk.last_node]
    corner = np.flatnonzero((passed < 0) & (walk.shared_point >= 0))
    which = (points[walk.site[corner], 0] != walk.shared_point[corner]).astype(np.intp)
    vertex, across = np.flatnonzero(~is_edge), np.flatnonzero(passed >= 0)
    neck, way = np.divmod(passed[across], 2)
    onward = np.where(is_edge[walk.after], walk.site[walk.after], -1)
    pieces = [
        (vertex, 0, ends[walk.site[vertex], 0], walk.point[vertex], onward[vertex]),
        (corner, 1, ends[walk.site[corner], which], walk.shared_point[corner], onward[corner]),
    ]
    number = _numbers(feet, ends, points)
    # the first way comes to the foot on its right, which is the right one of the cut; the second to the left one
    for rank, hand, edge in ((1, 1 - way, np.full(len(across), -1)), (2, way, onward[across])):
        pieces.append((across, rank, feet.xy[neck, hand], number[neck, hand], edge))
    run, xy, point, edge = (np.concatenate([piece[k] for piece in pieces]) for k in (0, 2, 3, 4))
    rank_of = np.repeat([piece[1] for piece in pieces], [len(piece[0]) for piece in pieces])
    order = np.lexsort((rank_of, run))
    contour = owners(np.diff(walk.start))[run[order]]
    kept = order[_is_last(xy[order], contour)]
    start = np.searchsorted(owners(np.diff(walk.start))[run[kept]], np.arange(len(walk.polygon) + 1))
    return Outlines(xy[kept], point[kept], edge[kept], start, walk.part, walk.polygon)


def _numbers(feet: Feet, ends: Floats, points: Indices) -> Indices:
    """(c, 2) the number of the vertex that each foot is at, -1 for none."""
    number = np.full(feet.site.shape, -1)
    for end in (1, 0):
        is_there = (feet.xy == ends[feet.site, end]).all(axis=2)
        number = np.where(is_there, points[feet.site, end], number)
    return number


def _is_last(xy: Floats, contour: Indices) -> NDArray[np.bool_]:
    """Whether what follows around a contour is another place, or nothing."""
    after = following(np.searchsorted(contour, np.arange(int(contour.max(initial=-1)) + 2)))
    found: NDArray[np.bool_] = (xy != xy[after]).any(axis=1) | (after == np.arange(len(xy)))
    return found
