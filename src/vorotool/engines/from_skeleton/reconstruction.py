"""Polygons rebuilt from their skeletons: the envelopes of the discs along the arcs."""

from __future__ import annotations

from itertools import combinations, pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.arrangement.repaired_polygons import flat_holes
from vorotool.engines.common import twice_areas
from vorotool.engines.from_skeleton.contour_walk import (
    Contours,
    contours_of,
    cut_at_repetitions,
    repeats,
    site_points,
)
from vorotool.errors import UsageError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats, Indices, crosses, dots, norms, owners, starts_of
from vorotool.numeric.curves.flatten import chords_of, circle_tolerances, middles_of
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import Flatten, checked_flatten
from vorotool.types.arguments import check_value
from vorotool.types.polygons.polygon_set import HOLE, SHELL, PolygonSet
from vorotool.types.polygons.shapely_geometry import RingArrays
from vorotool.types.skeleton.segment_voronoi import EDGE, ends_of_sites
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton

_ULPS = 8
"""Of the largest coordinate: what two feet of one disc may differ by, times how much each is magnified."""

_MET = 4
"""Times as far a vertex may be that a place is drawn to: its number is known, and tells which one it is."""


def rebuild(skeleton: Skeleton, *, flatten: Flatten = None) -> PolygonSet:
    """Rebuild polygons from their interior skeleton, as the union of its discs.

    Edges are the common tangents of discs, vertices the common points of discs, both from places and radii of the
    skeleton alone; a vertex of the polygons that is met but for rounding is written as it was given. Where the skeleton
    was pruned the border is the circle of the disc that is left. Without pruning the polygons come back. An approximate
    skeleton tells no borders, but discs: the shape is what these cover.

    A point or a segment that is a hole comes back if nothing else touches it. An open line in a polygon, or such a hole
    from the border on, is a wall: where pruning leaves it on one side only, the ring goes along it twice.

    Parameters
    ----------
    skeleton : Skeleton
        Without a gap; pruned or not. Arcs outside make no difference.
    flatten : float or "auto", optional
        How far chords may be from circles, in input units; by default, or with "auto", 1/2000 of the radius of each.

    Returns
    -------
    PolygonSet
        Shells counter-clockwise (y upwards), holes clockwise; one polygon for each connected part, with the id and the
        properties of its own.

    Raises
    ------
    UsageError
        If the skeleton has a gap, or the tolerance is not positive.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> rebuild(skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]])).xy.tolist()
    [[4.0, 0.0], [4.0, 2.0], [0.0, 2.0], [0.0, 0.0]]
    """
    check_value(skeleton, "skeleton", "Skeleton")
    if skeleton.gap:
        raise UsageError(f"a skeleton with a gap of {skeleton.gap:g} leaves the corners out: use one without a gap")
    tolerance = checked_flatten(flatten)
    is_inside = skeleton.side == INTERIOR
    is_drawn = np.ones(len(skeleton), dtype=bool) if skeleton.error_bound.any() else _is_disc(skeleton)
    contours = contours_of(skeleton, np.flatnonzero(is_inside & ~is_drawn))
    rings = [*_simple_rings(contours, *_outline(skeleton, contours, tolerance)), *_flat_holes(skeleton, contours)]
    is_seen = skeleton.radius[skeleton.arcs].max(axis=1, initial=0) > _noise(skeleton)
    return _assembled(
        skeleton, [*rings, *covered_rings(skeleton, np.flatnonzero(is_inside & is_drawn & is_seen), tolerance)]
    )


# ---- feet ----------------------------------------------------------------------------------------
def _turned(way: Floats) -> Floats:
    """By 90 degrees, counter-clockwise."""
    return np.stack([-way[:, 1], way[:, 0]], axis=1)


@frozen
class _Feet:
    """Where the discs at the ends of each run touch its site, and by how much that magnifies errors of the discs."""

    first: Floats
    last: Floats
    first_factor: Floats
    last_factor: Floats


def _feet(skeleton: Skeleton, contours: Contours) -> _Feet:
    """Feet on each run's site, on its right: of an edge by the common tangent, of a vertex by the best of several."""
    discs = [_Discs(skeleton, node) for node in (contours.first_node, contours.middle_node, contours.last_node)]
    first, last, factors = _edge_feet(discs[0], discs[2])
    is_edge = skeleton.site_table.kind[contours.site] == EDGE
    before, after = contours.before, contours.after
    common = [_common_point(a, b) for a, b in combinations(discs, 2)]
    follows = np.where(is_edge[before] & contours.is_joined[before], factors[1][before], np.inf)
    leads = np.where(is_edge[after] & contours.is_joined, factors[0][after], np.inf)
    choices = np.stack([*(place for place, _ in common), last[before], first[after]])
    costs = np.stack([*(factor for _, factor in common), follows, leads])
    runs = np.arange(len(is_edge))
    best = np.argmin(costs, axis=0)
    vertex, factor = choices[best, runs], costs[best, runs]
    edge = is_edge[:, None]
    return _Feet(
        np.where(edge, first, vertex),
        np.where(edge, last, vertex),
        *(np.where(is_edge, own, factor) for own in factors),
    )


class _Discs:
    """Of nodes."""

    def __init__(self, skeleton: Skeleton, node: Indices) -> None:
        self.center, self.r = skeleton.vertices[node], skeleton.radius[node]


def _edge_feet(a: _Discs, b: _Discs) -> tuple[Floats, Floats, list[Floats]]:
    """Where the common tangent on the right of a -> b touches the discs, and by how much that magnifies errors."""
    way, growth = b.center - a.center, b.r - a.r
    square = np.maximum(dots(way, way), np.finfo(float).tiny)
    distance = np.sqrt(square)
    along = np.sqrt(np.maximum(distance - np.abs(growth), 0) * (distance + np.abs(growth)))
    inward = _turned((along[:, None] * way - growth[:, None] * _turned(way)) / square[:, None])
    factors = [np.divide(disc.r, along, out=np.zeros_like(along), where=along > 0) for disc in (a, b)]
    return a.center - a.r[:, None] * inward, b.center - b.r[:, None] * inward, factors


def _common_point(a: _Discs, b: _Discs) -> tuple[Floats, Floats]:
    """The point on the right of a -> b that is on both circles, and by how much that magnifies errors."""
    way = b.center - a.center
    square = np.maximum(dots(way, way), np.finfo(float).tiny)
    distance = np.sqrt(square)
    part = (square + (a.r - b.r) * (a.r + b.r)) / (2 * square)
    height = np.sqrt(np.maximum((a.r - part * distance) * (a.r + part * distance), 0))
    place = a.center + part[:, None] * way - (height / distance)[:, None] * _turned(way)
    factor = np.full(len(height), np.finfo(float).max)
    return place, np.divide(a.r * b.r, distance * height, out=factor, where=distance * height > 0)


def _noise(skeleton: Skeleton) -> float:
    """Bound of the error of feet."""
    largest = max(np.abs(skeleton.vertices).max(initial=0), np.abs(skeleton.radius).max(initial=0))
    return _ULPS * float(np.spacing(largest))


# ---- outlines ------------------------------------------------------------------------------------
def _outline(skeleton: Skeleton, contours: Contours, tolerance: float | None) -> tuple[Floats, Indices, Indices]:
    """Vertices of each contour, the point of the polygons that each is, -1 for none, and where contours begin."""
    feet = _feet(skeleton, contours)
    is_edge = skeleton.site_table.kind[contours.site] == EDGE
    node, after = contours.last_node, contours.after
    center, r = skeleton.vertices[node], skeleton.radius[node]
    start, end = feet.last, feet.first[after]
    noise = _noise(skeleton) * (1 + feet.last_factor + feet.first_factor[after])
    is_corner = r == 0
    between_edges = is_edge & is_edge[after]
    is_same = ~is_corner & (contours.is_joined | (between_edges & (norms(end - start) <= noise)))
    is_cap = ~is_corner & ~is_same
    better = (feet.last_factor <= feet.first_factor[after])[:, None]
    single = np.where(is_corner[:, None], center, np.where(better, start, end))
    factor = np.where(is_corner, 0, np.minimum(feet.last_factor, feet.first_factor[after]))
    plain = between_edges & ~is_cap
    pieces = [
        # a vertex stands where its run begins; between two edges there is one at a corner, or where they go on
        _Places(
            np.flatnonzero(~is_edge), 0, feet.first[~is_edge], contours.point[~is_edge], feet.first_factor[~is_edge]
        ),
        _Places(np.flatnonzero(plain), 1, single[plain], contours.shared_point[plain], factor[plain]),
        *_caps(is_cap, is_edge, after, start, end, center, tolerance),
    ]
    return _in_order(pieces, contours, skeleton)


@frozen
class _Places:
    """Places at runs: at the beginning (rank 0) or after the end (1 and more) of each, and how errors are magnified."""

    run: Indices
    rank: Any
    xy: Floats
    point: Any = -1
    factor: Any = np.inf


def _caps(
    is_cap: NDArray[np.bool_],
    is_edge: NDArray[np.bool_],
    after: Indices,
    start: Floats,
    end: Floats,
    center: Floats,
    tolerance: float | None,
) -> list[_Places]:
    """Chords of circles between feet; a foot on a vertex is there already."""
    run = np.flatnonzero(is_cap)
    a, b, c = start[run], end[run], center[run]
    u, v = a - c, b - c
    is_long = crosses(u, v) < 0  # over half a circle
    middle = middles_of(a, b, c, is_long)
    starts = np.concatenate([a, middle[is_long]])
    ends = np.concatenate([np.where(is_long[:, None], middle, b), b[is_long]])
    centers, runs = np.concatenate([c, c[is_long]]), np.concatenate([run, run[is_long]])
    rank = np.concatenate([np.ones(len(run)), np.full(int(is_long.sum()), 2)]).astype(np.int64)
    each = circle_tolerances(centers, hypotenuse(*(starts - centers).T), tolerance)
    xy, first = chords_of(starts, ends, centers, np.ones(len(runs), dtype=bool), each)
    piece = owners(np.diff(first))
    kept = (np.arange(len(xy)) > first[piece]) | (rank[piece] == 2) | is_edge[runs[piece]]
    to_edge = is_edge[after[run]]
    return [_Places(runs[piece[kept]], rank[piece[kept]], xy[kept]), _Places(run[to_edge], 3, b[to_edge])]


def _in_order(pieces: list[_Places], contours: Contours, skeleton: Skeleton) -> tuple[Floats, Indices, Indices]:
    run, xy = (np.concatenate([getattr(piece, name) for piece in pieces]) for name in ("run", "xy"))
    rank, point, factor = (
        np.concatenate([np.broadcast_to(getattr(piece, name), piece.run.shape) for piece in pieces])
        for name in ("rank", "point", "factor")
    )
    known = np.flatnonzero(point >= 0)
    known = known[np.lexsort((factor[known], point[known]))]
    vertex, best, number = np.unique(point[known], return_index=True, return_inverse=True)
    found, (placed, given) = xy[known[best]], _vertices(skeleton, vertex)
    off = np.abs(found - placed).max(axis=1, initial=0)
    is_vertex = off <= np.maximum(_MET * _noise(skeleton) * (1 + factor[known[best]]), skeleton.scale)
    xy[known] = np.where(is_vertex[:, None], given, found)[number]
    order = np.lexsort((rank, run))
    return xy[order], point[order], np.searchsorted(run[order], contours.start)


def _vertices(skeleton: Skeleton, point: Indices) -> tuple[Floats, Floats]:
    """Where the polygons have some points, as they were used and as they were given."""
    numbers, polygons = site_points(skeleton).reshape(-1), skeleton.polygons
    first = np.zeros(int(numbers.max(initial=-1)) + 1, dtype=np.int64)
    first[numbers[::-1]] = np.arange(len(numbers))[::-1]
    ends = (skeleton.site_ends, ends_of_sites(polygons.as_given, skeleton.site_table))
    placed, given = (each.reshape(-1, 2)[first[point]] for each in ends)
    return placed, given


# ---- rings ---------------------------------------------------------------------------------------
def _is_disc(skeleton: Skeleton) -> NDArray[np.bool_]:
    """(a,) whether each arc is a single place: all that pruning left of a connected part."""
    source, target = skeleton.vertices[skeleton.arcs].swapaxes(0, 1)
    return (source == target).all(axis=1) & (skeleton.degree[skeleton.arcs] == 1).all(axis=1)


def _simple_rings(contours: Contours, xy: Floats, point: Indices, start: Indices) -> list[Ring]:
    """Rings of contours: one that visits a point twice is cut in two there."""
    is_twice = repeats(point, start)
    rings = []
    for contour, (first, last) in enumerate(pairwise(start.tolist())):
        parts: list[Any] = [slice(first, last)]
        if is_twice[contour]:
            parts = [np.array(part) + first for part in cut_at_repetitions(point[first:last].tolist())]
        polygon, component = int(contours.polygon[contour]), int(contours.part[contour])
        rings += [Ring(xy[part], polygon, component) for part in parts]
    return [ring for ring in rings if len(ring.xy) > 2]


def _flat_holes(skeleton: Skeleton, contours: Contours) -> list[Ring]:
    """Points and segments that contours go around: they are there as they were, since pruning cuts no cycle."""
    polygons, table = skeleton.polygons.as_given, skeleton.site_table
    own = table.rings(polygons, contours.site)
    first = contours.start[:-1]
    is_around = np.minimum.reduceat(own, first) == np.maximum.reduceat(own, first) if len(first) else first > 0
    around = np.flatnonzero(is_around)
    around = around[flat_holes(skeleton.polygons)[own[first[around]]]]
    around = around[np.argsort(own[first[around]], kind="stable")]
    return [
        Ring(polygons.ring(ring), polygon, part)
        for ring, polygon, part in zip(
            own[first[around]].tolist(), contours.polygon[around].tolist(), contours.part[around].tolist(), strict=True
        )
    ]


def _assembled(skeleton: Skeleton, rings: list[Ring]) -> PolygonSet:
    """Polygons of rings: in each connected part of the skeleton one goes counter-clockwise, around the others."""
    start = starts_of([len(ring.xy) for ring in rings])
    is_hole = twice_areas(np.concatenate([np.empty((0, 2)), *(ring.xy for ring in rings)]), start) < 0
    is_hole |= np.diff(start) < 3
    part, polygon = (np.array([getattr(ring, name) for ring in rings], dtype=np.int64) for name in ("part", "polygon"))
    order = np.lexsort((is_hole, part, polygon))
    rings, is_hole = [rings[k] for k in order.tolist()], is_hole[order]
    made = RingArrays(
        np.concatenate([np.empty((0, 2)), *(ring.xy for ring in rings)]),
        np.array([len(ring.xy) for ring in rings], dtype=np.int64),
        np.where(is_hole, HOLE, SHELL),
        np.bincount(np.cumsum(~is_hole) - 1),
    )
    return made.polygons(skeleton.polygons, polygon[order[~is_hole]], frame=None, connectivity=None)


_QUARTERS = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])


class Ring(NamedTuple):
    """Vertices of a ring, the polygon that it is in, and a number of the connected part in it, the same for holes."""

    xy: Floats
    polygon: int
    part: int


def covered_rings(skeleton: Skeleton, arcs: Indices, tolerance: float | None) -> list[Ring]:
    """Rings around the discs along some arcs, polygon by polygon."""
    if not len(arcs):
        return []
    to_corner = _to_corner(skeleton, arcs)
    pairs, others = arcs[to_corner], arcs[~to_corner]
    single, first = np.unique(skeleton.arcs[others], return_index=True)
    xy, circle = _circles(skeleton, np.concatenate([single, skeleton.arcs[pairs].reshape(-1)]), tolerance)
    piece = np.where(circle < len(single), circle, (circle + len(single)) // 2)
    pieces = shapely.convex_hull(shapely.multipoints(xy, indices=piece))
    own = skeleton.polygon[np.concatenate([others[first // 2], pairs])]
    order = np.argsort(own, kind="stable")
    polygons, start = np.unique(own[order], return_index=True)
    rings = []
    for polygon, part_of in zip(polygons.tolist(), np.split(pieces[order], start[1:]), strict=True):
        whole = shapely.union_all(part_of)
        for part, shape in enumerate(shapely.get_parts(whole).tolist()):
            turned = shapely.geometry.polygon.orient(shape)
            places = [shapely.get_coordinates(ring)[:-1] for ring in (turned.exterior, *turned.interiors)]
            rings += [Ring(place, polygon, ~part) for place in places]
    return rings


def _to_corner(skeleton: Skeleton, arcs: Indices) -> NDArray[np.bool_]:
    """(k,) whether the sites of each arc have an end in common."""
    left, right = skeleton.site_ends[skeleton.sites[arcs].T]
    return (left[:, :, None] == right[:, None]).all(axis=-1).any(axis=(1, 2))


def _circles(skeleton: Skeleton, node: NDArray[np.integer], tolerance: float | None) -> tuple[Floats, Indices]:
    """Vertices of the circle about each node, and which circle each is of."""
    center, r = (np.repeat(values[node], 4, axis=0) for values in (skeleton.vertices, skeleton.radius))
    ways = r[:, None] * np.tile(_QUARTERS, (len(node), 1))
    ends = r[:, None] * np.tile(np.roll(_QUARTERS, -1, axis=0), (len(node), 1))
    is_left = np.ones(len(r), dtype=bool)
    xy, first = chords_of(center + ways, center + ends, center, is_left, circle_tolerances(center, r, tolerance))
    return xy, np.repeat(np.arange(len(r)) // 4, np.diff(first))
