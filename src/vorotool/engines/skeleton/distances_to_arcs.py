"""Distances of places from the arcs of skeletons."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import owners
from vorotool.types.skeleton.skeleton import Skeleton

Places = NDArray[np.float64]

FLATTEN = 2.0**-12
"""Of the extent: how finely arcs are flattened to find those that may be nearest."""
STARTS = 8
"""Parts of a parabola from the ends of which Newton's method starts: on each the distance has one minimum at most."""
NEWTON_STEPS = 40


def places_on_arcs(skeleton: Skeleton, parameters: NDArray[np.float64]) -> Places:
    """(a, k, 2) places on each arc, by the parameter of the Bezier curve that it is."""
    source, control, target = (corner[:, None] for corner in _bezier(skeleton))
    t = parameters[None, :, None]
    places: Places = np.square(1 - t) * source + 2 * t * (1 - t) * control + t * t * target
    return places


def distances_to(skeleton: Skeleton, places: Places) -> NDArray[np.float64]:
    """(n,) distances of places from the nearest arc, right to a few ulp of the coordinates."""
    import shapely

    tolerance = FLATTEN * float(np.ptp(np.concatenate([skeleton.vertices, places]), axis=0).max() or 1.0)
    points, start = skeleton.flattened(tolerance)
    lines = shapely.linestrings(points, indices=owners(np.diff(start)))
    tree = shapely.STRtree(lines)
    geometry = shapely.points(places)
    _, about = tree.query_nearest(geometry, return_distance=True, all_matches=False)
    row, arc = tree.query(geometry, predicate="dwithin", distance=about + 2 * tolerance)
    nearest = np.full(len(places), np.inf)
    source, control, target = _bezier(skeleton)
    for is_bent in (False, True):
        own = skeleton.is_parabola[arc] == is_bent
        r, a = row[own], arc[own]
        curve = source[a], control[a], target[a]
        found = _from_parabola(places[r], *curve) if is_bent else _from_segment(places[r], curve[0], curve[2])
        np.minimum.at(nearest, r, found)
    return nearest


def _bezier(skeleton: Skeleton) -> tuple[Places, Places, Places]:
    source, target = skeleton.vertices[skeleton.arcs].swapaxes(0, 1)
    return source, np.where(skeleton.is_parabola[:, None], skeleton.control, (source + target) / 2), target


def _from_segment(x: Places, a: Places, b: Places) -> NDArray[np.float64]:
    way = b - a
    square = (way * way).sum(axis=1)
    t = np.divide(((x - a) * way).sum(axis=1), square, out=np.zeros(len(x)), where=square > 0)
    away = x - a - np.clip(t, 0, 1)[:, None] * way
    return np.asarray(np.sqrt((away * away).sum(axis=1)))


def _from_parabola(x: Places, source: Places, control: Places, target: Places) -> NDArray[np.float64]:
    """The least of the distances at minima that Newton's method finds from several places."""
    first, bend = 2 * (control - source), source - 2 * control + target
    offset = source - x

    def away(t: NDArray[np.float64]) -> Places:
        moved: Places = offset + t[:, None] * (first + t[:, None] * bend)
        return moved

    best = np.full(len(x), np.inf)
    for start in np.linspace(0, 1, STARTS + 1):
        t = np.full(len(x), start)
        for _ in range(NEWTON_STEPS):
            from_x, tangent = away(t), first + 2 * t[:, None] * bend
            slope = (from_x * tangent).sum(axis=1)
            curvature = (tangent * tangent).sum(axis=1) + 2 * (from_x * bend).sum(axis=1)
            step = np.divide(slope, np.abs(curvature), out=np.zeros(len(x)), where=curvature != 0)
            moved = np.clip(t - step, 0, 1)
            if np.array_equal(moved, t):
                break
            t = moved
        distance = away(t)
        best = np.minimum(best, np.sqrt((distance * distance).sum(axis=1)))
    return best
