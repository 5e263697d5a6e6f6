"""The middles of the ends of strips.

The disc at a leaf of a skeleton touches both sides of a strip. The *end* of the strip is the outline beyond it, from
one of these places to the other, however many vertices it has. It has two *shoulders*, where it turns from the sides:
each is half-way between the two points of the end that are farthest in the directions at about 37 and 53 degrees from
the axis to that side (their sines are 3/5 and 4/5). So the shoulders of a flat or an oblique end are its corners, and
they move little if the outline does. The *middle* is where the ray from the leaf through the point half-way between the
shoulders meets the end: on a single edge it is the midpoint. If that point is well before the end, the end is round,
and its middle is where the axis itself meets it.

The axis is not normal to an oblique end, and the strip may bend beyond the leaf. So directions are taken twice more,
from half-way between the axis and the normal of the line from shoulder to shoulder.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.centerlines.walks import Walks
from vorotool.engines.from_skeleton.boundary_rays import first_crossings
from vorotool.numeric.ragged import owners, starts_of, within
from vorotool.plain import plain
from vorotool.types.skeleton.skeleton import EDGE, Skeleton

Floats = NDArray[np.float64]
Numbers = NDArray[np.intp]
Booleans = NDArray[np.bool_]

FLAT = 0.9
"""How far ahead the point half-way between shoulders is where an end is flat, as a part of the way to the outline. In a
semicircle it is at 0.7."""

SINGLE = 1.75
"""In radii of the leaf: an edge of pixels that is longer is no step, but nearly as long as the strip is wide."""

TIMES = 3
"""How often directions are taken."""


@plain(eq=False)
class EndMiddles:
    """Middles of ends."""

    places: Floats  # (k, 2) float64 array: NaN where there is none
    vertices: Numbers  # (k,) integer array: where the edges begin that they are on; -1 for none


@plain(eq=False)
class _Outlines:
    """The outline of each end: a place on a side, vertices of the polygon, a place on the other side."""

    start: Numbers  # (k + 1,) integer array: where the points of each begin
    points: Floats  # (n, 2) float64 array: from the leaf
    vertex: Numbers  # (n,) integer array: the vertices that points are, or at first places those before
    is_vertex: Booleans  # (n,) bool array: whether they are
    is_left: Booleans  # (k,) bool array: whether each turns to the left at corners that the inside goes into


def end_middles(skeleton: Skeleton, leaves: Numbers) -> EndMiddles:
    """Find the middles of the ends of strips beyond leaves inside."""
    walks = Walks(skeleton, leaves)
    origin, arcs, at_target = skeleton.vertices[leaves], walks.arcs, walks.at_target
    sites = np.where(at_target[:, None], skeleton.sites[arcs], skeleton.sites[arcs][:, ::-1]).astype(np.intp)
    ways = walks.directions(is_smooth=skeleton.polygons.connectivity is None)
    places, vertices = np.full((len(arcs), 2), np.nan), np.full(len(arcs), -1, dtype=np.intp)
    table = skeleton.site_table
    own = (table.polygon[sites] == skeleton.polygon[arcs][:, None]).all(axis=1) & (ways != 0).any(axis=1)
    chosen = np.flatnonzero(own & (table.ring[sites[:, 0]] == table.ring[sites[:, 1]]))
    if len(chosen):
        outlines = _outlines(skeleton, sites[chosen], origin[chosen])
        to_middle, corners = _half_way(outlines, ways[chosen])
        if skeleton.polygons.connectivity is not None:  # of pixels: shoulders are steps
            _set_single_edges(outlines, skeleton.radius[leaves[chosen]], to_middle, corners)
        met, edges = _met(skeleton, outlines, origin[chosen], to_middle, corners)
        is_round = _square(to_middle) < FLAT * FLAT * _square(met - origin[chosen])
        axis, beyond = _met(skeleton, outlines, origin[chosen], ways[chosen], corners)
        places[chosen] = np.where(is_round[:, None], axis, met)
        vertices[chosen] = np.where(is_round, beyond, edges)
    return EndMiddles(places, vertices)


# ---- outlines -------------------------------------------------------------------------------------
def _touched(skeleton: Skeleton, sites: Numbers, origin: Floats) -> Floats:
    """(k, 2, 2) the places on both sites that are nearest to some places."""
    a, b = skeleton._ends_of(sites).transpose(2, 0, 1, 3)
    way = b - a
    square = (way * way).sum(axis=-1)
    along = ((origin[:, None] - a) * way).sum(axis=-1)
    at = np.clip(np.divide(along, square, out=np.zeros_like(along), where=square > 0), 0, 1)
    places: Floats = a + at[..., None] * way
    return places


def _outlines(skeleton: Skeleton, sites: Numbers, origin: Floats) -> _Outlines:
    """Outlines in the order of their rings, from the one of two sites to the other."""
    touched = _touched(skeleton, sites, origin) - origin[:, None]
    polygons, table = skeleton.polygons, skeleton.site_table
    ring = (polygons.polygon_starts[table.polygon[sites[:, 0]]] + table.ring[sites[:, 0]]).astype(np.intp)
    # what is inside is on the left of shells that go counterclockwise, and of holes that do not
    is_forward = (_areas(skeleton)[ring] > 0) == (table.ring[sites[:, 0]] == 0)
    order = np.where(is_forward[:, None], [1, 0], [0, 1])
    rows = np.arange(len(sites))[:, None]
    (begin, end), touched = sites[rows, order].T, touched[rows, order]
    size = np.diff(polygons.ring_starts)[ring]
    steps = (table.index[end].astype(np.intp) - table.index[begin]) % size
    count = np.maximum(steps - (table.kind[end] != EDGE), 0)
    start, outline, along = starts_of(count + 2), owners(count + 2), within(count + 2)
    vertex = polygons.ring_starts[ring][outline] + (table.index[begin][outline] + along) % size[outline]
    points = polygons.xy[vertex] - origin[outline]
    points[start[:-1]], points[start[1:] - 1] = touched[:, 0], touched[:, 1]
    is_vertex = np.ones(len(points), dtype=bool)
    is_vertex[start[:-1]] = is_vertex[start[1:] - 1] = False
    return _Outlines(start, points, vertex, is_vertex, is_forward)


def _areas(skeleton: Skeleton) -> Floats:
    """Twice the signed area of each ring."""
    polygons = skeleton.polygons
    start = polygons.ring_starts
    xy = polygons.xy - np.repeat(polygons.xy[start[:-1]], np.diff(start), axis=0)
    x, y = xy.T
    behind = polygons.following
    areas: Floats = np.add.reduceat(x * y[behind] - x[behind] * y, start[:-1])
    return areas


# ---- shoulders ------------------------------------------------------------------------------------
def _half_way(outlines: _Outlines, ways: Floats) -> tuple[Floats, Numbers]:
    """(k, 2) points half-way between shoulders; and (k, 2) the points that both are, -1 where they are none."""
    axis = _unit(ways)
    for _ in range(TIMES):
        left = np.stack([-axis[:, 1], axis[:, 0]], axis=1)
        (one, at_one), (other, at_other) = (_shoulder(outlines, axis, side) for side in (left, -left))
        across = one - other
        normal = _unit(np.stack([across[:, 1], -across[:, 0]], axis=1))
        axis = _unit(axis + normal)
    return one / 2 + other / 2, np.stack([at_one, at_other], axis=1)


def _set_single_edges(outlines: _Outlines, radius: Floats, to_middle: Floats, corners: Numbers) -> None:
    """Take, where it is the only one, a long edge between corners that stick out."""
    way = np.diff(outlines.points, axis=0)
    turn = way[:-1, 0] * way[1:, 1] - way[:-1, 1] * way[1:, 0]
    outline = owners(np.diff(outlines.start))
    sticks_out = np.zeros(len(outlines.points), dtype=bool)
    sticks_out[1:-1] = outlines.is_vertex[1:-1] & (np.where(outlines.is_left[outline[1:-1]], turn, -turn) > 0)
    edge = np.flatnonzero(sticks_out[:-1] & sticks_out[1:])
    least = SINGLE * radius[outline[edge]]
    edge = edge[_square(way[edge]) > least * least]
    edge = edge[np.bincount(outline[edge], minlength=len(radius))[outline[edge]] == 1]
    to_middle[outline[edge]] = outlines.points[edge] / 2 + outlines.points[edge + 1] / 2
    corners[outline[edge]] = np.stack([edge, edge + 1], axis=1)


def _shoulder(outlines: _Outlines, axis: Floats, side: Floats) -> tuple[Floats, Numbers]:
    """The shoulders on one side; and which points they are."""
    first, second = (_farthest(outlines, a * axis + b * side) for a, b in ((4, 3), (3, 4)))
    return outlines.points[first] / 2 + outlines.points[second] / 2, np.where(first == second, first, -1)


def _farthest(outlines: _Outlines, way: Floats) -> Numbers:
    """The point of each outline that is farthest in a direction, the first of several."""
    start, outline = outlines.start, owners(np.diff(outlines.start))
    reach = (outlines.points * way[outline]).sum(axis=1)
    at = np.flatnonzero(reach == np.maximum.reduceat(reach, start[:-1])[outline])
    first: Numbers = at[np.diff(outline[at], prepend=-1) > 0]
    return first


def _square(ways: Floats) -> Floats:
    squares: Floats = (ways * ways).sum(axis=1)
    return squares


def _unit(ways: Floats) -> Floats:
    size = np.sqrt((ways * ways).sum(axis=1))[:, None]
    units: Floats = np.divide(ways, size, out=np.zeros_like(ways), where=size > 0)
    return units


# ---- rays -----------------------------------------------------------------------------------------
def _met(
    skeleton: Skeleton, outlines: _Outlines, origin: Floats, way: Floats, corners: Numbers
) -> tuple[Floats, Numbers]:
    """Where rays meet outlines first, and where the edges begin that they meet; midpoints of whole edges exactly."""
    polygons = skeleton.polygons
    edge = np.delete(np.arange(len(outlines.points)), outlines.start[1:] - 1)
    ray = owners(np.diff(outlines.start) - 1)
    at, met = first_crossings(ray, outlines.points[edge], outlines.points[edge + 1], way)
    places, vertices = np.full((len(way), 2), np.nan), np.full(len(way), -1, dtype=np.intp)
    hit = np.flatnonzero(met >= 0)
    places[hit] = origin[hit] + at[hit]
    one = edge[met[hit]]
    vertices[hit] = outlines.vertex[one]
    a, b = polygons.xy[vertices[hit]], polygons.xy[polygons.following[vertices[hit]]]
    places[hit] = np.where(a == b, a, places[hit])  # exactly on edges along an axis
    is_whole = (np.sort(corners[hit], axis=1) == np.stack([one, one + 1], axis=1)).all(axis=1)
    is_whole &= outlines.is_vertex[one] & outlines.is_vertex[np.minimum(one + 1, len(outlines.vertex) - 1)]
    places[hit[is_whole]] = a[is_whole] / 2 + b[is_whole] / 2
    return places, vertices
