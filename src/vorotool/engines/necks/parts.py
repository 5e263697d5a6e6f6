"""Polygons cut into pieces at their necks: the decomposition of shapes of the paper."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.common import twice_areas
from vorotool.engines.from_skeleton.contour_walk import (
    contours_of,
    cut_at_repetitions,
    repeats,
    site_points,
)
from vorotool.engines.necks.necks import Feet, FoundNecks, Ways, check_neck, found_necks, whole_skeleton
from vorotool.engines.skeleton.parts import PER_ARC
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats, Indices, connected_roots, following, owners, ranges, ranks_of
from vorotool.numeric.parallel import Progress
from vorotool.types.polygons.planar_graph import moved_feet, places_as_given
from vorotool.types.polygons.polygon_set import HOLE, SHELL, PolygonSet
from vorotool.types.polygons.shapely_geometry import RingArrays
from vorotool.types.skeleton.necks import Necks, Parts
from vorotool.types.skeleton.segment_voronoi import EDGE
from vorotool.types.skeleton.skeleton import Skeleton

if TYPE_CHECKING:
    from vorotool.typing import FeaturesChoice, PolygonsLike

NARROWEST = 0.5
"""The ratio of `parts` by default."""


def parts(
    polygons: PolygonsLike | Skeleton,
    *,
    neck: float = NARROWEST,
    features: FeaturesChoice = "separate",
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Parts:
    """Cut polygons into pieces at their necks.

    All necks whose half width is at most `neck` times the smaller of the largest clearances beside, as `necks` finds
    them, are cut from foot to foot. A cut that has the same piece on both sides, as that of a single narrow place of a
    ring, parts nothing and is left out. Where the boundary touches itself pieces are apart without any cut.

    Parameters
    ----------
    polygons : PolygonSet, shapely geometry, GeoSeries, GeoJSON, (n, 2) array, …, a list of these, or Skeleton
        As for :func:`necks`.
    neck : float
        The largest ratio of necks that are cut, from 0 to 1: 1 cuts all.
    features : {"separate", "together"}
        Take each feature by itself, or all of them as one drawing.
    strict, threads, progress : optional
        As for :func:`vorotool.skeleton_exact`.

    Returns
    -------
    Parts
        Polygon by polygon; the areas of the pieces of one sum to its own, but for rounding. There is none of an open
        line, nor of a polygon without an inside.

    Raises
    ------
    InputError
        As for :func:`vorotool.skeleton_exact`.
    UsageError
        If the ratio is invalid, or the skeleton is approximate, pruned, or has a gap.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 3.

    Examples
    --------
    >>> dumbbell = [[0, 0], [4, 0], [4, 1], [6, 1], [6, 0], [10, 0], [10, 4], [6, 4], [6, 3], [4, 3], [4, 4], [0, 4]]
    >>> parts(dumbbell).area.tolist(), len(parts(dumbbell, neck=0.4))
    ([18.0, 18.0], 1)
    """
    check_neck(neck)
    skeleton = whole_skeleton(polygons, features=features, strict=strict, threads=threads, progress=progress)
    return cut_parts(found_necks(skeleton, threads=threads, progress=progress), neck)


def cut_parts(found: FoundNecks, neck: float) -> Parts:
    """Cut at those necks whose ratio is at most `neck`, but for cuts that part nothing."""
    chosen = np.flatnonzero(found.necks.ratio <= neck)
    sides = _cut(found, chosen)
    a, b = sides.part[sides.node].T
    chosen = chosen[a != b]
    axis = _cut(found, chosen)
    feet, necks = found.feet[chosen], found.necks.taken(chosen)
    return _parts_of(axis, _as_given(outlines_of(axis, feet), feet, necks), necks)


def _as_given(outlines: Outlines, feet: Feet, necks: Necks) -> Outlines:
    """Outlines with corners where vertices were given, and feet on edges as these were."""
    skeleton, polygon = necks.skeleton, np.repeat(outlines.polygon, np.diff(outlines.start))
    given = moved_feet(skeleton, feet.site, feet.xy)
    others = np.repeat(necks.polygon, 2), feet.xy.reshape(-1, 2), given.reshape(-1, 2)
    together = skeleton.features == "together"
    xy = places_as_given(outlines.xy, polygon, skeleton.polygons, together=together, others=others)
    return replace(outlines, xy=xy)


def _cut(found: FoundNecks, chosen: Indices) -> CutAxis:
    necks = found.necks
    return cut_axis(necks.skeleton, found.ways[chosen], necks.xy[chosen], necks.width[chosen])


# ---- pieces --------------------------------------------------------------------------------------
@frozen(eq=False)
class _Rings:
    """Rings, the part that each is around, and its polygon."""

    xy: Floats
    start: Indices
    part: Indices
    polygon: Indices


def _rings(outlines: Outlines) -> _Rings:
    """Simple rings, each from its vertex with the least x: a contour that visits a vertex twice is cut in two there."""
    is_twice = repeats(outlines.point, outlines.start)
    rings: list[Indices] = []
    owner: list[int] = []
    for contour, (first, last) in enumerate(pairwise(outlines.start.tolist())):
        pieces = [list(range(last - first))]
        if is_twice[contour]:
            pieces = [part for part in cut_at_repetitions(outlines.point[first:last].tolist()) if len(part) > 2]
        for piece in pieces:
            ring = _without_spikes(first + np.array(piece), outlines.edge)
            if not len(ring) or (is_twice[contour] and len(ring) < 3):  # around a line alone nothing is left
                continue
            least = int(np.lexsort(outlines.xy[ring].T[::-1])[0])
            rings.append(np.roll(ring, -least))
            owner.append(contour)
    contour_of = np.array(owner, dtype=np.int64)
    start = np.concatenate([[0], np.cumsum([len(ring) for ring in rings], dtype=np.int64)])
    order = np.concatenate([np.empty(0, dtype=np.int64), *rings])
    return _Rings(outlines.xy[order], start, outlines.part[contour_of], outlines.polygon[contour_of])


def _without_spikes(ring: Indices, edge: Indices) -> Indices:
    """Leave out where a ring goes along an edge and back, around the end of a line inside the polygon."""
    onward = edge[ring]
    is_tip = (onward == np.roll(onward, 1)) & (onward >= 0)
    return ring[~is_tip] if is_tip.any() else ring


def _parts_of(axis: CutAxis, outlines: Outlines, necks: Necks) -> Parts:
    rings = _rings(outlines)
    skeleton = axis.skeleton
    radius, center = _largest_discs(axis)
    # the shell is the one ring of a part that goes counter-clockwise, so that of the largest area
    areas, corner = twice_areas(rings.xy, rings.start), rings.xy[rings.start[:-1]]
    by_area = np.lexsort((-areas, rings.part))
    shells = by_area[np.flatnonzero(np.diff(rings.part[by_area], prepend=-1))]
    part, low = rings.part[shells], corner[shells]
    columns = (center[part, 1], center[part, 0], low[:, 1], low[:, 0], rings.polygon[shells])
    order = np.lexsort(columns)
    part, source = part[order], rings.polygon[shells][order]
    piece = ranks_of(part, len(skeleton.vertices))
    is_hole = np.ones(len(areas), dtype=bool)
    is_hole[shells] = False
    ring_order = np.lexsort((corner[:, 1], corner[:, 0], is_hole, piece[rings.part]))
    polygons = _polygons(skeleton.polygons, rings, ring_order, is_hole, source, piece[rings.part])
    between = np.sort(piece[axis.part[axis.node]], axis=1).astype(np.int32)
    return Parts(polygons, source.astype(np.int32), radius[part], center[part], necks, between)


def _largest_discs(axis: CutAxis) -> tuple[Floats, Floats]:
    """Radius and center of the largest disc of each part, by the node that the part is named after."""
    skeleton, part = axis.skeleton, axis.part
    radius, center = np.zeros(len(part)), np.full((len(part), 2), np.nan)
    inner = np.flatnonzero(skeleton.radius[: len(part) - axis.node.size] > 0)
    x, y = skeleton.vertices[inner].T
    order = inner[np.lexsort((y, x, -skeleton.radius[inner], part[inner]))]
    first = order[np.flatnonzero(np.diff(part[order], prepend=-1))]
    radius[part[first]], center[part[first]] = skeleton.radius[first], skeleton.vertices[first]
    return radius, center


def _polygons(
    given: PolygonSet,
    rings: _Rings,
    order: Indices,
    is_hole: NDArray[np.bool_],
    source: Indices,
    piece: Indices,
) -> PolygonSet:
    """The pieces, each a feature, with what is said of their polygons."""
    sizes = np.diff(rings.start)
    corners = ranges(rings.start[order], sizes[order])
    kind = np.where(is_hole, HOLE, SHELL).astype(np.int8)
    made = RingArrays(rings.xy[corners], sizes[order], kind[order], np.bincount(piece, minlength=len(source)))
    return made.polygons(given, source, feature=np.arange(len(source), dtype=np.int32), connectivity=None)


@frozen(eq=False)
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
    made = replace(
        skeleton,
        vertices=np.concatenate([skeleton.vertices, np.repeat(xy, 2, axis=0)]),
        radius=np.concatenate([skeleton.radius, np.repeat(width / 2, 2)]),
        arcs=np.concatenate([arcs, halves]),
        **{name: getattr(skeleton, name)[every] for name in PER_ARC if name != "arcs"},
    )
    return CutAxis(made, node, _parts(made))


def _parts(skeleton: Skeleton) -> Indices:
    """(v,) the smallest node that each is connected with, not through corners: of these one way's at random."""
    ends = skeleton.arcs.astype(np.int64)
    is_corner = skeleton.radius[ends] == 0
    apart = len(skeleton.vertices) + np.arange(ends.size).reshape(-1, 2)
    return connected_roots(np.where(is_corner, apart, ends), len(skeleton.vertices) + ends.size)[: len(skeleton.radius)]


@frozen(eq=False)
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
    return (xy != xy[after]).any(axis=1) | (after == np.arange(len(xy)))
