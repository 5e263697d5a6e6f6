"""How coarse polylines may be so that they do not pass corners of cuts that their curves leave on the other side."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.curves.mixed_arcs import MixedArcs
from vorotool.geometry.voronoi.voronoi_map import VoronoiMap

Floats = NDArray[np.float64]

FINEST = 2.0**-30
"""Of the size of an arc: corners that are nearer to it than a step of the lattice do not make polylines finer."""


def room_beside_cuts(cells: VoronoiMap) -> Floats:
    """(a,) half the distance of arcs from the corners of cuts between them and their chords; infinity where none is.

    A straight cut that does not cross a curve and ends beyond what is between the curve and its chord does not cross a
    polyline either. So the ends of cuts there tell.

    Parameters
    ----------
    cells : VoronoiMap
        With a clip or enclosures; others have no corner between an arc and its chord.

    Examples
    --------
    >>> from vorotool import voronoi
    >>> float(room_beside_cuts(voronoi([[0, 0], [4, 0]])).min())
    inf
    """
    arcs = cells.mixed_arcs
    room = np.full(len(cells.arcs), np.inf)
    curved = np.flatnonzero(cells.is_parabola | cells.is_circle)
    if (cells.clip is None and cells.enclosures is None) or not curved.size:
        return room
    import shapely

    corner = np.unique(cells.arcs[cells.is_cut])
    hulls = _hulls(arcs[curved])
    row, at = shapely.STRtree(shapely.points(cells.vertices[corner])).query(
        shapely.polygons(hulls), predicate="intersects"
    )
    arc, vertex = curved[row], corner[at]
    inner = (cells.arcs[arc] != vertex[:, None]).all(axis=1)
    arc, vertex = arc[inner], vertex[inner]
    place = cells.vertices[vertex]
    near = np.where(cells.is_circle[arc], _from_circles(arcs[arc], place), _from_parabolas(arcs[arc], place))
    size = np.ptp(hulls, axis=1).max(axis=1)[row[inner]]
    np.minimum.at(room, arc, np.maximum(near / 2, FINEST * size))
    return room


def _hulls(arcs: MixedArcs) -> Floats:
    """(k, 5, 2) closed rings around curves: two chords or tangents, and the chord between both ends."""
    corner = [arcs.control, arcs.control]
    if arcs.is_circle.any():
        a, b = arcs.source - arcs.center, arcs.target - arcs.center
        chord = np.where(arcs.is_left[:, None], b - a, a - b)
        middle = np.where(((a * b).sum(axis=1) > 0)[:, None], a + b, np.stack([chord[:, 1], -chord[:, 0]], axis=1))
        square = (a * a).sum(axis=1)[:, None]
        size = np.sqrt((middle * middle).sum(axis=1))[:, None]
        middle = middle * np.sqrt(square) / np.where(size > 0, size, 1)
        of_circles = [
            arcs.center + (one + middle) * square / (square + (one * middle).sum(axis=1)[:, None]) for one in (a, b)
        ]
        corner = [np.where(arcs.is_circle[:, None], circle, arcs.control) for circle in of_circles]
    hulls: Floats = np.stack([arcs.source, *corner, arcs.target, arcs.source], axis=1)
    return hulls


def _from_circles(arcs: MixedArcs, place: Floats) -> Floats:
    offset, end = place - arcs.center, arcs.source - arcs.center
    near: Floats = np.abs(np.sqrt((offset * offset).sum(axis=1)) - np.sqrt((end * end).sum(axis=1)))
    return near


def _from_parabolas(arcs: MixedArcs, place: Floats) -> Floats:
    """(k,) no more than the distance of places in the triangles of Bezier curves from these.

    With u, v, w the weights of the three control points at a place, v^2 - 4 u w is 0 on the curve. What this is
    elsewhere, over the most that it can rise by, is less than the distance.
    """
    a, b, c = arcs.source, arcs.control, arcs.target
    double = _cross(b - a, c - a)
    with np.errstate(divide="ignore", invalid="ignore"):
        u, w = _cross(b - place, c - place) / double, _cross(a - place, b - place) / double
        rise = (2 * _size(c - a) + 4 * (_size(c - b) + _size(b - a))) / np.abs(double)
        near: Floats = np.abs((1 - u - w) ** 2 - 4 * u * w) / rise
    return np.where(np.isfinite(near), near, 0)


def _cross(a: Floats, b: Floats) -> Floats:
    made: Floats = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return made


def _size(way: Floats) -> Floats:
    made: Floats = np.sqrt((way * way).sum(axis=1))
    return made
